// Between the targets of a motion controller: where the motion that they were taken from was, one cycle ago.
#include "stiction/motion/set_point_interpolator.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "firmware/machine/configuration/conversion.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using Interpolator = SetPointInterpolator;
using S = FixedSignals;
constexpr double tick = 62.5e-6;  // s

Interpolator interpolator(std::uint32_t ticks) {
  return Interpolator(Interpolator::configure(62500, ticks, *machine::to_signal<Interpolator::Way>(10e-3)));
}
S::Position position(double x) { return *machine::to_signal<S::Position>(x); }
double rounded(double x, double increment) { return std::round(x / increment) * increment; }

struct Largest {
  double position = 0.0, velocity = 0.0, acceleration = 0.0;  // off the motion
  double velocity_step = 0.0, acceleration_step = 0.0;        // from tick to tick
};

// A motion x(t), its velocity and acceleration, as targets of whole increments.
Largest follow(std::uint32_t ticks, int cycles, double increment,
               const std::function<std::array<double, 3>(double)>& at) {
  auto in = interpolator(ticks);
  Largest largest;
  const double cycle = ticks * tick;
  double v_before = 0.0, a_before = 0.0;
  in.start(position(at(0.0)[0]));
  for (int k = 1; k <= cycles; ++k) {
    in.take(position(rounded(at(k * cycle)[0], increment)));
    for (std::uint32_t i = 0; i < ticks; ++i) {
      const auto point = in.step();
      const auto wanted = at((k - 1) * cycle + i * tick);
      const double x = machine::to_si(point.position), v = machine::to_si(point.velocity),
                   a = machine::to_si(point.acceleration);
      largest.position = std::max(largest.position, std::abs(x - wanted[0]));
      largest.velocity = std::max(largest.velocity, std::abs(v - wanted[1]));
      largest.acceleration = std::max(largest.acceleration, std::abs(a - wanted[2]));
      largest.velocity_step = std::max(largest.velocity_step, std::abs(v - v_before));
      largest.acceleration_step = std::max(largest.acceleration_step, std::abs(a - a_before));
      v_before = v, a_before = a;
    }
  }
  return largest;
}

// 20 mm in half a second, without a step of the acceleration.
std::array<double, 3> smooth(double t) {
  constexpr double time = 0.5, way = 20e-3, turn = 2.0 * std::numbers::pi;
  if (t <= 0.0 || t >= time) return {t <= 0.0 ? 0.0 : way, 0.0, 0.0};
  const double s = t / time;
  return {way * (s - std::sin(turn * s) / turn), way / time * (1.0 - std::cos(turn * s)),
          way * turn / (time * time) * std::sin(turn * s)};
}

TEST(SetPointInterpolator, FollowsASmoothMotionOneCycleLateAndNoOtherwise) {
  const auto found = follow(16, 600, 1e-9, smooth);
  figure("targets of 1 nm each ms: position, velocity, acceleration off the motion",
         fmt::format("{:.2f} nm, {:.2f} um/s, {:.1f} mm/s^2 (bounds 2, 5, 20)", found.position * 1e9,
                     found.velocity * 1e6, found.acceleration * 1e3));
  EXPECT_LT(found.position, 2e-9);
  // Half an increment of each of four targets: 40/6 * 0.5 nm / 1 ms, and 12 * 0.5 nm / (1 ms)^2.
  EXPECT_LT(found.velocity, 5e-6);
  EXPECT_LT(found.acceleration, 20e-3);
}

// A step of the acceleration would be a step of the current: 0.5 m/s^2 from 0 to rest here.
TEST(SetPointInterpolator, MakesNoStepOfVelocityOrAcceleration) {
  for (const std::uint32_t ticks : {1u, 3u, 10u, 16u, 40u}) {
    SCOPED_TRACE(ticks);
    const auto found = follow(ticks, 600 * 16 / static_cast<int>(ticks), 1e-12, smooth);
    // Of the motion itself: 0.503 m/s^2, and 6.3 m/s^3 over a tick.
    EXPECT_LT(found.velocity_step, 0.503 * tick * 1.01 + 8e-9);
    // Where the motion's jerk of 6.32 m/s^3 begins, the acceleration of a cycle comes within that cycle, with some
    // overshoot; and a picometre of the target and of the format times 12 / cycle^2.
    const double cycle = ticks * tick;
    EXPECT_LT(found.acceleration_step, 1.5 * 6.32 * cycle + 12.0 * 1.9e-12 / (cycle * cycle));
  }
}

TEST(SetPointInterpolator, IsExactForAMotionOfConstantJerk) {
  auto in = interpolator(16);
  constexpr double jerk = 1000.0, cycle = 1e-3;
  const auto x = [&](double t) { return jerk * t * t * t / 6.0; };
  in.start({});
  double off = 0.0;
  for (int k = 1; k <= 40; ++k) {
    in.take(position(x(k * cycle)));
    for (int i = 0; i < 16; ++i) {
      const double t = (k - 1) * cycle + i * tick;
      const auto point = in.step();
      if (k <= 5) continue;  // once four targets are those of the cubic, and the beginning of the segment too
      off = std::max(off, std::abs(machine::to_si(point.acceleration) - jerk * t));
      EXPECT_NEAR(machine::to_si(point.position), x(t), 5e-12);
    }
  }
  EXPECT_LT(off, 1e-4);  // targets in steps of 0.9 pm
}

TEST(SetPointInterpolator, ReachesEveryTargetWhateverTheyAre) {
  auto in = interpolator(16);
  in.start({});
  double target = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double next = target + 9e-3 * std::sin(k * k * 0.7);
    in.take(position(next));
    EXPECT_NEAR(machine::to_si(in.step().position), target, 2e-12);
    for (int i = 1; i < 16; ++i) in.step();
    target = next;
  }
}

TEST(SetPointInterpolator, GoesOnWithItsAccelerationWhereNoTargetCame) {
  for (const int missing : {1, 2}) {
    auto in = interpolator(16);
    constexpr double cycle = 1e-3, a = 8.0;
    const auto x = [&](double t) { return a * t * t / 2.0; };
    in.start({});
    double off = 0.0;
    for (int k = 1; k <= 30; ++k) {
      if (k > 20 && k <= 20 + missing)
        in.extrapolate();
      else
        in.take(position(rounded(x(k * cycle), 1e-9)));
      for (int i = 0; i < 16; ++i) {
        const double here = machine::to_si(in.step().position);
        if (k > 5) off = std::max(off, std::abs(here - x((k - 1) * cycle + i * tick)));
      }
    }
    // Targets within half a nanometre, taken on by 3, -3, 1 and once more.
    EXPECT_LT(off, 12e-9) << missing;
  }
}

TEST(SetPointInterpolator, GoesOnNoFasterThanItsLargestWay) {
  for (const double side : {1.0, -1.0}) {
    auto in = interpolator(16);
    in.start({});
    in.take(position(side * 9.0e-3));
    in.take(position(side * 18.8e-3));  // 9.8 mm, and 0.8 mm more than the cycle before
    in.extrapolate();
    EXPECT_NEAR(machine::to_si(in.target()), side * 28.8e-3, 2e-12);
  }
}

TEST(SetPointInterpolator, StaysAtATargetAfterWhichNoneComes) {
  auto in = interpolator(16);
  in.start({});
  in.take(position(3e-3));
  for (int i = 0; i < 16; ++i) in.step();
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(machine::to_si(in.step().position), 3e-3, 2e-12);
}

// The promise of at_rest(), held to what the set-point does: targets a few units of the format apart, where its
// rounding decides, and then the same ones.
TEST(SetPointInterpolator, SaysThatItIsAtRestWhenAndOnlyWhenItStandsFromTheNextCycleOn) {
  constexpr int cycles = 9, ways = 2;
  for (std::int64_t first = -7; first <= 7; ++first)
    for (std::int64_t second = -7; second <= 7; ++second) {
      SCOPED_TRACE(std::to_string(first) + ", " + std::to_string(second));
      auto in = interpolator(4);
      in.start({});
      std::array<bool, cycles> says{}, stands{};
      std::int64_t target = 0;
      for (int k = 0; k < cycles; ++k) {
        target += k == 0 ? first : k == 1 ? second : 0;
        in.take(S::Position::from_raw(target));
        says[k] = in.at_rest();
        stands[k] = true;
        for (int i = 0; i < 4; ++i) {
          const auto point = in.step();
          stands[k] =
              stands[k] && point.position.raw() == target && point.velocity.raw() == 0 && point.acceleration.raw() == 0;
        }
      }
      for (int k = 0; k < cycles; ++k) {
        if (says[k] && (k > 0 || second == 0)) {  // from here on the targets stand
          for (int later = k + 1; later < cycles; ++later) EXPECT_TRUE(stands[later]) << k << ", " << later;
        }
      }
      // A way is forgotten after four more targets.
      EXPECT_EQ(says[0], first == 0);
      EXPECT_EQ(says[1], first == 0 && second == 0);
      EXPECT_TRUE(says[ways + 4]);
    }
}

TEST(SetPointInterpolator, StandsWhereItWasStarted) {
  auto in = interpolator(16);
  in.start(position(-0.3));
  for (int i = 0; i < 100; ++i) {
    if (i % 16 == 0) in.take(position(-0.3));
    const auto point = in.step();
    EXPECT_EQ(machine::to_si(point.position), machine::to_si(position(-0.3)));
    EXPECT_EQ(point.velocity.raw(), 0);
    EXPECT_EQ(point.acceleration.raw(), 0);
  }
  EXPECT_TRUE(in.at_rest());
}

}  // namespace
}  // namespace stiction::test
