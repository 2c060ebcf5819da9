// A source of set-points against motions in double precision: followed where it can be, at the limit where it cannot.
#include "stiction/motion/speed_step_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
constexpr double limited_tick = 62.5e-6, most_acceleration = 20.0;  // s, m/s^2

struct Followed {
  double largest_step = 0.0;  // m/s
  double largest_lag = 0.0;   // m
  double inconsistent = 0.0;  // m, of position and mean speed in a tick
  int ticks_beside = 0;
  bool ends_with_it = false;
};

SpeedStepLimit limit_of(double largest_lag = 2e-3) {
  return SpeedStepLimit({machine::to_signal<S::Velocity>(most_acceleration * limited_tick).value(), S::seconds(31'250),
                         S::rate(62'500), machine::to_signal<S::Position>(largest_lag).value()});
}

// `velocity`: of the source over time, m/s; its position is the sum of the trapezoids.
Followed follow(const std::function<double(double)>& velocity, int ticks) {
  auto limit = limit_of();
  limit.start({});
  Followed f;
  double x_source = 0.0, x = 0.0, v = 0.0;
  for (int i = 1; i <= ticks; ++i) {
    const double t = i * limited_tick, wanted = velocity(t);
    x_source += 0.5 * (velocity(t - limited_tick) + wanted) * limited_tick;
    const SpeedStepLimit::Point source{
        machine::to_signal<S::Position>(x_source).value(), machine::to_signal<S::Velocity>(wanted).value(), {}};
    const auto point = limit.step(source);
    const double x_now = machine::to_si(point.position), v_now = machine::to_si(point.velocity);
    f.largest_step = std::max(f.largest_step, std::abs(v_now - v));
    f.largest_lag = std::max(f.largest_lag, std::abs(x_source - x_now));
    f.inconsistent = std::max(f.inconsistent, std::abs(x_now - x - 0.5 * (v + v_now) * limited_tick));
    f.ends_with_it = point.position == source.position && point.velocity == source.velocity;
    f.ticks_beside += f.ends_with_it ? 0 : 1;
    x = x_now;
    v = v_now;
  }
  return f;
}

TEST(SpeedStepLimit, LeavesASourceWithinItAsItIs) {
  const auto f = follow([](double t) { return 0.1 * std::sin(150.0 * t); }, 5000);  // 15 m/s^2
  EXPECT_EQ(f.ticks_beside, 0);
  EXPECT_LE(f.largest_lag, 1e-12);
}

// A step of the speed takes dv / a, in which the way dv^2 / (2 a) is lost, and at most as much again and a half to make
// it up: up by a and down by a from what was lost, 2 sqrt(w / a) = sqrt(2) dv / a.
TEST(SpeedStepLimit, MakesUpForAStepAtTheLimitAndJoins) {
  for (const double step : {-0.8, -0.05, 2e-3, 0.01, 0.2, 0.8}) {
    SCOPED_TRACE(step);
    const auto f = follow([step](double t) { return t > 0.01 ? step : 0.0; }, 8000);
    EXPECT_LE(f.largest_step, most_acceleration * limited_tick + 4e-9);
    EXPECT_TRUE(f.ends_with_it);
    const double lost = step * step / 2.0 / most_acceleration, ramp = std::abs(step) / most_acceleration;
    EXPECT_NEAR(f.largest_lag, lost, std::abs(step) * limited_tick);
    EXPECT_LE(f.ticks_beside * limited_tick, (1.0 + std::sqrt(2.0)) * ramp * 1.02 + 8 * limited_tick);
    EXPECT_LE(f.inconsistent, 0.25 * most_acceleration * limited_tick * limited_tick + 4e-12);
  }
}

// Sources that accelerate too much for a while, to and fro, and ones that use the limit to the full.
TEST(SpeedStepLimit, JoinsBehindEveryMotionThatItCouldNotFollow) {
  const std::vector<std::function<double(double)>> sources{
      [](double t) { return t < 0.1 ? 0.3 * std::sin(200.0 * t) : 0.3 * std::sin(20.0); },
      [](double t) { return t < 0.05  ? 21.0 * t
                            : t < 0.1 ? 21.0 * (0.1 - t)
                                      : 0.0; },
      [](double t) { return t < 0.05 ? std::min(20.0 * t + 0.003, 0.9) : 0.9; },
      [](double t) { return t < 0.2 ? (std::fmod(t, 0.02) < 0.01 ? 0.1 : -0.1) : 0.0; },
  };
  double longest = 0.0;
  for (const auto& source : sources) {
    const auto f = follow(source, 8000);
    EXPECT_LE(f.largest_step, most_acceleration * limited_tick + 4e-9);
    EXPECT_TRUE(f.ends_with_it);
    longest = std::max(longest, f.ticks_beside * limited_tick);
  }
  EXPECT_LT(longest, 0.3);
}

TEST(SpeedStepLimit, SaysWhenTheSourceIsTooFarAhead) {
  auto limit = limit_of(1e-4);
  limit.start({});
  const auto far = SpeedStepLimit::Point{machine::to_signal<S::Position>(0.9e-4).value(), {}, {}};
  limit.step(far);
  EXPECT_TRUE(limit.follows());
  for (int i = 0; i < 400; ++i) limit.step(far);
  EXPECT_EQ(limit.step(far).position, far.position);
  for (const double x : {3e-4, -3e-4, 0.5, -0.5}) {
    limit.step({machine::to_signal<S::Position>(x).value(), {}, {}});
    EXPECT_FALSE(limit.follows());
  }
}

TEST(SquareRoot, IsTheLargestWholeNumberWhoseSquareIsNotAbove) {
  for (std::uint64_t i = 0; i < 70'000; ++i) {
    const std::uint64_t x = i * i;
    ASSERT_EQ(square_root(x), i);
    ASSERT_EQ(square_root(i > 1 ? x - 1 : x), i > 1 ? i - 1 : i);
    ASSERT_EQ(square_root(x + i), i);
  }
  EXPECT_EQ(square_root(UINT64_MAX), 0xffff'ffffu);
}

}  // namespace
}  // namespace stiction::test
