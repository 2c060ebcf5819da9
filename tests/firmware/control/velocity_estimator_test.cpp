// Velocity from time-stamped positions: the mean velocity of an interval, at the interval's middle.
#include "stiction/control/velocity_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

constexpr std::int64_t tick_ns = 62500;

// Feeds x(t) sampled at `times_ns` to an estimator that starts at rest at the first of them.
template <class S>
class Estimator {
 public:
  Estimator(VelocityFeedback kind, double x, std::int64_t t_ns, std::int64_t period_ns = tick_ns)
      : kind_(kind), state_(VelocityEstimator<S>::start(position(x), t_ns, period_ns)) {}

  // Velocity in m/s; its time stamp in time_ns.
  double step(double x, std::int64_t t_ns, double given = 0.0) {
    const auto estimate = VelocityEstimator<S>::estimate(
        state_, kind_, position(x), t_ns, machine::to_signal<typename S::Velocity>(given).value(), saturations);
    VelocityEstimator<S>::push(state_, position(x), t_ns);
    time_ns = estimate.time_ns;
    return machine::to_si(estimate.velocity);
  }

  std::int64_t time_ns = 0;
  SaturationCounter saturations;

 private:
  static typename S::Position position(double x) { return machine::to_signal<typename S::Position>(x).value(); }

  VelocityFeedback kind_;
  typename VelocityEstimator<S>::State state_;
};

// Each position is half a bit of 2^-40 m off; a relative error of the rate comes from its own rounding, 2^-11 1/s.
template <class S>
double tolerance(double speed, std::int64_t interval_ns) {
  if (std::is_same_v<S, machine::DoubleSignals>) return 1e-9;  // positions of 1 m end at 1.1e-16: 4e-12 m/s per tick
  const double interval = 1e-9 * static_cast<double>(interval_ns);
  return 0x1p-40 / interval + std::abs(speed) * (0x1p-11 * interval + 0x1p-29) + 0x1p-29;
}

template <class S>
class VelocityEstimatorOf : public ::testing::Test {};
using Policies = ::testing::Types<FixedSignals, machine::DoubleSignals>;
TYPED_TEST_SUITE(VelocityEstimatorOf, Policies);

TYPED_TEST(VelocityEstimatorOf, GivesAConstantVelocityAtTheMiddleOfTheTick) {
  for (const double v : {1.6, -1.3, 1e-3, -1e-6, 0.0}) {
    Estimator<TypeParam> estimator(VelocityFeedback::difference, 0.0, 0);
    for (std::int64_t n = 1; n < 100; ++n) {
      const std::int64_t t = n * tick_ns;
      const double found = estimator.step(v * 1e-9 * static_cast<double>(t), t);
      if (n == 1) continue;  // from the rest before the start
      ASSERT_NEAR(found, v, tolerance<TypeParam>(v, tick_ns));
      ASSERT_EQ(estimator.time_ns, t - tick_ns / 2);
    }
    EXPECT_EQ(estimator.saturations.count, 0u);
  }
}

TYPED_TEST(VelocityEstimatorOf, AtConstantAccelerationIsTheVelocityOfItsTimeStamp) {
  constexpr double a = 20.0;
  for (const auto kind : {VelocityFeedback::difference, VelocityFeedback::mean_difference}) {
    Estimator<TypeParam> estimator(kind, 0.0, 0);
    for (std::int64_t n = 1; n < 800; ++n) {
      const std::int64_t t = n * tick_ns;
      const double si = 1e-9 * static_cast<double>(t);
      const double found = estimator.step(0.5 * a * si * si, t);
      if (n < 3) continue;
      ASSERT_NEAR(found, a * 1e-9 * static_cast<double>(estimator.time_ns), tolerance<TypeParam>(a * si, tick_ns)) << n;
      ASSERT_EQ(estimator.time_ns, kind == VelocityFeedback::difference ? t - tick_ns / 2 : t - tick_ns);
    }
  }
}

TYPED_TEST(VelocityEstimatorOf, TakesJitterOfTheSamplesFromTheirTimeStamps) {
  constexpr double v = 0.8;
  const std::vector<std::int64_t> jitter{0, 7000, -12000, 300, -1, 12345, 0, -9999, 4000};
  Estimator<TypeParam> estimator(VelocityFeedback::difference, 0.0, 0);
  std::int64_t before = 0;
  for (std::int64_t n = 1; n < 1000; ++n) {
    const std::int64_t t = n * tick_ns + jitter[static_cast<std::size_t>(n) % jitter.size()];
    const double found = estimator.step(v * 1e-9 * static_cast<double>(t), t);
    // Taken for a tick each, intervals 24 us off would show as 0.3 m/s.
    if (n > 1) {
      ASSERT_NEAR(found, v, tolerance<TypeParam>(v, t - before)) << n;
      ASSERT_EQ(estimator.time_ns, before + (t - before) / 2);
    }
    before = t;
  }
}

TYPED_TEST(VelocityEstimatorOf, BridgesAMissedSampleByTheLongerInterval) {
  constexpr double v = -0.5;
  Estimator<TypeParam> estimator(VelocityFeedback::difference, 0.0, 0);
  for (std::int64_t n = 1; n < 30; ++n) {
    if (n == 10 || n == 20 || n == 21) continue;
    const std::int64_t t = n * tick_ns;
    const double found = estimator.step(v * 1e-9 * static_cast<double>(t), t);
    if (n < 2) continue;
    ASSERT_NEAR(found, v, tolerance<TypeParam>(v, tick_ns)) << n;
    const std::int64_t ticks = n == 11 ? 2 : n == 22 ? 3 : 1;
    ASSERT_EQ(estimator.time_ns, t - ticks * tick_ns / 2) << n;
  }
}

TYPED_TEST(VelocityEstimatorOf, MeanDifferenceIsTheRuleOfTheEmpsController) {
  // v[k] = (qf[k] - qf[k-1]) / T with qf[k] = (q[k] + q[k-1]) / 2, any positions.
  constexpr std::int64_t period_ns = 1000000;
  Estimator<TypeParam> estimator(VelocityFeedback::mean_difference, 0.0, 0, period_ns);
  std::vector<double> q{0.0};
  estimator.step(q[0], 0);
  for (std::int64_t n = 1; n < 300; ++n) {
    q.push_back(1e-3 * std::sin(0.05 * static_cast<double>(n)) + 1e-5 * static_cast<double>((n * 7919) % 13));
    const double found = estimator.step(q.back(), n * period_ns);
    if (n < 2) continue;
    const auto k = static_cast<std::size_t>(n);
    const double rule = ((q[k] + q[k - 1]) / 2.0 - (q[k - 1] + q[k - 2]) / 2.0) / 1e-3;
    // Fixed point rounds each position to 2^-40 m and the rate of 500 1/s by less than 2^-11 1/s of 0.25 mm.
    ASSERT_NEAR(found, rule, 0x1p-40 / 2e-3 + 0x1p-28 + 2.5e-4 * 0x1p-11) << n;
    ASSERT_EQ(estimator.time_ns, (n - 1) * period_ns);
  }
}

TYPED_TEST(VelocityEstimatorOf, AGivenVelocityHoldsAtItsSample) {
  Estimator<TypeParam> estimator(VelocityFeedback::given, 0.0, 0);
  EXPECT_EQ(estimator.step(0.123, tick_ns, 0.5), 0.5);
  EXPECT_EQ(estimator.time_ns, tick_ns);
}

TYPED_TEST(VelocityEstimatorOf, StartsAtRestWhereverTheAxisStands) {
  Estimator<TypeParam> estimator(VelocityFeedback::difference, -1.75, 10 * tick_ns);
  EXPECT_EQ(estimator.step(-1.75, 10 * tick_ns), 0.0);
  EXPECT_EQ(estimator.time_ns, 10 * tick_ns - tick_ns / 2);
}

TEST(VelocityEstimator, KeepsItsPrecisionFarFromTheOriginAndAfterWeeks) {
  constexpr double v = 0.8;
  constexpr std::int64_t weeks_ns = 30 * 86400 * std::int64_t{1000000000};
  Estimator<FixedSignals> estimator(VelocityFeedback::difference, 1900.0, weeks_ns);
  for (std::int64_t n = 1; n < 50; ++n) {
    const double found = estimator.step(1900.0 + v * 1e-9 * static_cast<double>(n * tick_ns), weeks_ns + n * tick_ns);
    // A double of 1900 m ends at 2.3e-13 m; two of them over a tick are 7.3e-9 m/s.
    if (n == 1) continue;
    ASSERT_NEAR(found, v, tolerance<FixedSignals>(v, tick_ns) + 7.3e-9) << n;
  }
}

TEST(VelocityEstimator, AJumpBeyondItsStepSaturatesAndCounts) {
  Estimator<FixedSignals> estimator(VelocityFeedback::difference, 0.0, 0);
  const double found = estimator.step(0.5, tick_ns);  // 2 mm are the format's end
  EXPECT_NEAR(found, 8.0, 1e-8) << "saturated, of the right sign, not wrapped";
  EXPECT_GE(estimator.saturations.count, 1u);
}

// A delay line filled with 0, 1, .. m/s: its value at a delay is the delay's distance from the newest.
template <class S>
double read_ramp(double delay_ticks, int pushes = 20) {
  typename SpeedDelay<S>::State state;
  for (int i = 0; i < pushes; ++i)
    SpeedDelay<S>::push(state, machine::to_signal<typename S::Velocity>(0.0625 * i).value());
  SaturationCounter saturations;
  const auto delay = S::ticks(std::llround(delay_ticks * tick_ns),
                              machine::to_signal<typename S::PeriodInverse>(1.0 / tick_ns).value());
  return (0.0625 * (pushes - 1) - machine::to_si(SpeedDelay<S>::read(state, delay, saturations))) / 0.0625;
}

template <class S>
class SpeedDelayOf : public ::testing::Test {};
TYPED_TEST_SUITE(SpeedDelayOf, Policies);

TYPED_TEST(SpeedDelayOf, InterpolatesBetweenTicks) {
  for (const double delay : {0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.75, 4.0})
    // One bit of the velocity, of 1/16 m/s per tick, and the delay's own rounding.
    EXPECT_NEAR(read_ramp<TypeParam>(delay), delay, 0x1p-28 / 0.0625 + 0x1p-26);
}

TYPED_TEST(SpeedDelayOf, ReadsItsEndsBeyondThem) {
  EXPECT_NEAR(read_ramp<TypeParam>(-0.5), 0.0, 1e-7);
  EXPECT_NEAR(read_ramp<TypeParam>(-1e6), 0.0, 1e-7);
  EXPECT_NEAR(read_ramp<TypeParam>(4.5), 4.0, 1e-7);
  EXPECT_NEAR(read_ramp<TypeParam>(1e6), 4.0, 1e-7);
}

TYPED_TEST(SpeedDelayOf, StartsAtRest) { EXPECT_NEAR(read_ramp<TypeParam>(4.0, 1), 0.0, 1e-7); }

TEST(SpeedDelay, InterpolatesAcrossTheWholeRangeWithoutOverflow) {
  SpeedDelay<FixedSignals>::State state;
  SpeedDelay<FixedSignals>::push(state, Fixed<28>::from_raw(INT32_MIN));
  SpeedDelay<FixedSignals>::push(state, Fixed<28>::from_raw(INT32_MAX));
  SaturationCounter saturations;
  const auto middle = SpeedDelay<FixedSignals>::read(state, FixedSignals::Ticks::from_raw(1 << 27), saturations);
  EXPECT_NEAR(middle.raw(), 0, 1);
  EXPECT_EQ(saturations.count, 0u);
}

}  // namespace
}  // namespace stiction
