// The border between double precision and the drive's formats.
#include "firmware/machine/configuration/conversion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/experiment/set_point.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction::machine {
namespace {

using F = FixedSignals;

template <class T>
class ConversionOf : public ::testing::Test {};
using Formats =
    ::testing::Types<F::Position, F::Distance, F::Step, F::Velocity, F::Acceleration, F::Current, F::Voltage, F::Ticks,
                     F::TickFraction, F::Seconds, F::PositionGain, F::VelocityGain, F::IncrementInverse, F::Increment,
                     F::FilterCoefficient, F::PitchInverse, F::PeriodInverse, F::Rate>;
TYPED_TEST_SUITE(ConversionOf, Formats);

// raw * 2^-bits, exact for words below 2^53.
template <class T>
double value_of(std::int64_t raw) {
  return std::ldexp(static_cast<double>(raw), -T::fraction_bits);
}

TYPED_TEST(ConversionOf, RefusesWhatIsNotANumber) {
  for (const double value :
       {std::nan(""), -std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()})
    EXPECT_FALSE(to_signal<TypeParam>(value)) << value;
}

TYPED_TEST(ConversionOf, TakesItsEndsAndRefusesTheFirstValueBeyondThem) {
  using T = TypeParam;
  const double high = value_of<T>(T::highest_raw), low = value_of<T>(T::lowest_raw);
  ASSERT_TRUE(to_signal<T>(high));
  ASSERT_TRUE(to_signal<T>(low));
  EXPECT_EQ(to_signal<T>(high)->raw(), T::highest_raw);
  EXPECT_EQ(to_signal<T>(low)->raw(), T::lowest_raw);
  EXPECT_EQ(highest<T>(), high);
  // Half a bit beyond an end rounds away from it; where double has no such number (2^61), its next one is refused.
  const double half = std::ldexp(0.5, -T::fraction_bits);
  const double above = std::max(high + half, std::nextafter(high, INFINITY));
  const double below = std::min(low - half, std::nextafter(low, -INFINITY));
  EXPECT_FALSE(to_signal<T>(above));
  EXPECT_FALSE(to_signal<T>(below));
}

TYPED_TEST(ConversionOf, RoundsTiesAwayFromZero) {
  using T = TypeParam;
  for (const int raw : {0, 1, 2, 7}) {
    const double tie = std::ldexp(raw + 0.5, -T::fraction_bits);
    EXPECT_EQ(to_signal<T>(tie)->raw(), raw + 1);
    EXPECT_EQ(to_signal<T>(-tie)->raw(), -raw - 1);
    EXPECT_EQ(to_signal<T>(std::nextafter(tie, 0.0))->raw(), raw) << "just below the tie of " << raw;
    EXPECT_EQ(to_signal<T>(-std::nextafter(tie, 0.0))->raw(), -raw);
  }
  EXPECT_EQ(to_signal<T>(5e-324)->raw(), 0);
  EXPECT_EQ(to_signal<T>(-0.0)->raw(), 0);
}

TYPED_TEST(ConversionOf, GoesThereAndBackWithoutLoss) {
  using T = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const auto signal = test::drawn<T>();
    // Words above 2^53 (positions beyond 8 km) lose bits in double itself.
    RC_PRE(std::abs(std::int64_t{signal.raw()}) <= std::int64_t{1} << 53);
    RC_ASSERT(to_signal<T>(to_si(signal)) == signal);
  }));
}

TEST(Conversion, OfAnyNumberIsTheNearestWord) {
  EXPECT_TRUE(rc::check([] {
    const double value =
        std::ldexp(static_cast<double>(test::drawn_between(-(std::int64_t{1} << 52), std::int64_t{1} << 52)),
                   -static_cast<int>(test::drawn_between(44, 70)));
    const auto signal = to_signal<F::Velocity>(value);
    const double raw = std::ldexp(value, F::Velocity::fraction_bits);
    if (!signal)
      RC_ASSERT(raw > 2147483647.0 || raw < -2147483648.0);
    else
      RC_ASSERT(std::abs(signal->raw() - raw) <= 0.5);
  }));
}

TEST(Conversion, OfADoubleSignalOnlyRefusesWhatIsNotFinite) {
  EXPECT_EQ(to_signal<Real>(1e300)->value, 1e300);
  EXPECT_FALSE(to_signal<Real>(std::nan("")));
  EXPECT_FALSE(to_signal<Real>(INFINITY));
  EXPECT_EQ(highest<Real>(), INFINITY);
}

TEST(SetPointConversion, MarksASetPointThatCannotBeRepresented) {
  const double nan = std::nan(""), inf = INFINITY;
  EXPECT_TRUE(sim::to_set_point<F>({1.0, 0.5, 2.0}).valid);
  for (const sim::AxisSetPoint& bad :
       {sim::AxisSetPoint{nan, 0.0, 0.0}, sim::AxisSetPoint{0.0, nan, 0.0}, sim::AxisSetPoint{0.0, 0.0, nan},
        sim::AxisSetPoint{inf, 0.0, 0.0}, sim::AxisSetPoint{0.0, 8.0, 0.0}, sim::AxisSetPoint{0.0, 0.0, 512.0},
        sim::AxisSetPoint{3e6, 0.0, 0.0}}) {
    const auto set = sim::to_set_point<F>(bad);
    EXPECT_FALSE(set.valid);
    EXPECT_EQ(set.position.raw(), 0) << "and carries nothing of it over";
    EXPECT_EQ(set.velocity.raw(), 0);
    EXPECT_EQ(set.acceleration.raw(), 0);
  }
  EXPECT_FALSE(sim::to_set_point<DoubleSignals>({0.0, nan, 0.0}).valid);
}

}  // namespace
}  // namespace stiction::machine
