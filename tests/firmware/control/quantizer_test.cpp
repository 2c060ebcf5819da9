// The position error's quantizer: nearest increment, ties away from zero, in both signal policies.
#include "stiction/control/quantizer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

template <class S>
typename Quantizer<S>::Config config(double increment) {
  return {true, machine::to_signal<typename S::IncrementInverse>(1.0 / increment).value(),
          machine::to_signal<typename S::Increment>(increment).value()};
}

template <class S>
double quantised(double x, double increment) {
  SaturationCounter saturations;
  const auto y =
      Quantizer<S>::apply(config<S>(increment), machine::to_signal<typename S::Distance>(x).value(), saturations);
  EXPECT_EQ(saturations.count, 0u);
  return machine::to_si(y);
}

template <class S>
class QuantizerOf : public ::testing::Test {};
using Policies = ::testing::Types<FixedSignals, machine::DoubleSignals>;
TYPED_TEST_SUITE(QuantizerOf, Policies);

// The output is a whole number of increments rounded to the format's last bit, 2^-32 m; double is exact to 1e-15.
constexpr double half_bit = 0x1p-33;

TYPED_TEST(QuantizerOf, GivesTheNearestIncrement) {
  for (int n = -50; n <= 50; ++n)
    for (const double rest : {-0.49, -0.2, 0.0, 0.3, 0.49})
      EXPECT_NEAR(quantised<TypeParam>((n + rest) * 1e-6, 1e-6), n * 1e-6, 1.001 * half_bit) << n << " + " << rest;
}

TYPED_TEST(QuantizerOf, BreaksTiesAwayFromZero) {
  // An increment of 2^-20 m makes the ties numbers of the format.
  constexpr double increment = 0x1p-20;
  for (int n = 0; n < 40; ++n) {
    EXPECT_EQ(quantised<TypeParam>((n + 0.5) * increment, increment), (n + 1) * increment);
    EXPECT_EQ(quantised<TypeParam>(-(n + 0.5) * increment, increment), -(n + 1) * increment);
  }
}

TYPED_TEST(QuantizerOf, IsOdd) {
  for (double x = 0.0; x < 1e-5; x += 1.37e-8)
    EXPECT_EQ(quantised<TypeParam>(-x, 1e-6), -quantised<TypeParam>(x, 1e-6)) << x;
}

TYPED_TEST(QuantizerOf, DisabledLetsEverythingPass) {
  using S = TypeParam;
  SaturationCounter saturations;
  const auto x = machine::to_signal<typename S::Distance>(1.234567e-7).value();
  EXPECT_EQ(Quantizer<S>::apply({}, x, saturations), x);
}

TYPED_TEST(QuantizerOf, WorksFromTheSmallestToALargeIncrement) {
  for (const double increment : {1e-9, 1e-8, 1e-7, 5e-6, 5e-5})
    for (const double increments : {0.4, 0.6, 1.0, 7.4, -7.6, 1000.0}) {
      const double x = increments * increment;
      // 1 nm is 4.3 bits of the format: the input itself is half a bit off, then the output.
      EXPECT_NEAR(quantised<TypeParam>(x, increment), std::round(increments) * increment, 2.001 * half_bit)
          << increments << " of " << increment;
    }
}

RC_GTEST_PROP(Quantizer, FixedPointIsTheExactCountTimesTheIncrement, ()) {
  using S = FixedSignals;
  const auto c = config<S>(1e-6);
  const auto x = test::drawn<S::Distance>();
  SaturationCounter saturations;
  const auto y = Quantizer<S>::apply(c, x, saturations);
  const auto count = test::rescaled(test::Int128{x.raw()} * c.per_metre.raw(), S::Distance::fraction_bits, 0);
  RC_ASSERT(std::int64_t{y.raw()} == test::expected_raw<S::Distance>(count * c.increment.raw(), 44));
}

RC_GTEST_PROP(Quantizer, FixedPointAndDoubleDifferOnlyWithinARoundingOfATie, ()) {
  const auto x = test::drawn<FixedSignals::Distance>();
  const double metres = machine::to_si(x);
  const double fixed = quantised<FixedSignals>(metres, 1e-6);
  const double real = quantised<machine::DoubleSignals>(metres, 1e-6);
  // The increment is held in 2^-44 m: 2.8e-8 of it, 1.4e-8 m over the largest error of 0.5 m.
  const double scale_error = 0.5 * 0x1p-44 / 1e-6 * std::abs(metres) + half_bit;
  RC_ASSERT(std::abs(fixed - real) <= scale_error);
}

}  // namespace
}  // namespace stiction
