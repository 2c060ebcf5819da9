// The notch by sines, at standstill and at its rounding's limits. notch_oracle.py compares it with scipy.
#include "stiction/control/notch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/firmware/control/notch_fixture.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using Fix = FixedSignals;
using Dbl = machine::DoubleSignals;
using test::NotchFilter;

constexpr double rate = 16000.0;  // Hz
constexpr double bit = 0x1p-20;   // A
constexpr machine::NotchParameters cross_table{2000.0, 0.05, 0.7};
constexpr machine::NotchParameters low{50.0, 0.05, 0.7};

// |G| of (3.19), Omega_1 = Omega_2, on the frequency axis that the bilinear transform stretches by its tangent.
double expected_gain(const machine::NotchParameters& n, double frequency) {
  const std::complex<double> s(
      0.0, std::tan(std::numbers::pi * frequency / rate) / std::tan(std::numbers::pi * n.frequency / rate));
  return std::abs((s * s + 2.0 * n.numerator_damping * s + 1.0) / (s * s + 2.0 * n.denominator_damping * s + 1.0));
}

// Gain for a sine of `amplitude` A, by correlation over whole periods after it has swung in.
template <class S>
double measured_gain(const machine::NotchParameters& n, double frequency, double amplitude) {
  NotchFilter<S> filter(n);
  std::complex<double> sum = 0.0;
  const int settle = 16000, whole = 16000;  // both whole periods of any whole frequency
  for (int k = 0; k < settle + whole; ++k) {
    const double phase = 2.0 * std::numbers::pi * frequency * k / rate;
    const double y = filter.step(amplitude * std::sin(phase));
    if (k >= settle) sum += y * std::exp(std::complex<double>(0.0, -phase));
  }
  EXPECT_EQ(filter.saturations.count, 0u);
  return 2.0 * std::abs(sum) / (whole * amplitude);
}

TEST(Notch, PassesSinesByTheMagnitudeOfItsTransferFunction) {
  for (const double f : {1.0, 100.0, 1000.0, 1900.0, 2000.0, 2100.0, 3000.0, 7000.0}) {
    EXPECT_NEAR(measured_gain<Dbl>(cross_table, f, 100.0), expected_gain(cross_table, f), 1e-10) << f << " Hz";
    // Coefficients within 2^-29 over |A| >= 0.38, and half bits of 100 A that average out.
    EXPECT_NEAR(measured_gain<Fix>(cross_table, f, 100.0), expected_gain(cross_table, f), 5 * 0x1p-29 / 0.38 + 1e-8)
        << f << " Hz";
  }
}

TEST(Notch, IsDeepestAtItsOwnFrequencyByTheRatioOfItsDampings) {
  EXPECT_NEAR(measured_gain<Fix>(cross_table, 2000.0, 100.0), 0.05 / 0.7, 1e-7);
  EXPECT_LT(measured_gain<Fix>({2000.0, 0.0, 0.7}, 2000.0, 100.0), 1e-7) << "no damping: nothing passes";
  // |A| of the 50 Hz notch is 5.3e-4 at its own frequency; coefficients within 2^-29.
  EXPECT_NEAR(measured_gain<Fix>(low, 50.0, 100.0), 0.05 / 0.7, 5 * 0x1p-29 / 5.3e-4);
}

// The filter's output under a constant input, settled for five seconds.
template <class S>
double settled(const machine::NotchParameters& n, double x) {
  NotchFilter<S> filter(n);
  double y = 0.0;
  for (int k = 0; k < 80000; ++k) y = filter.step(x);
  return y;
}

TEST(Notch, PassesAStandingCurrentExactly) {
  // The header: "the gain at standstill is exact".
  for (const auto& notch : {cross_table, machine::NotchParameters{700.0, 0.1, 0.5}})
    for (const double x : {40.0, -40.0, 1.0, 3 * bit, -bit, 0.0})
      EXPECT_NEAR(settled<Fix>(notch, x), x, bit) << notch.frequency << " Hz, " << x << " A";
}

TEST(Notch, PassesAStandingCurrentExactlyAtALowFrequencyToo) {
  // (1 + a1 + a2) is 3.8e-4 at 50 Hz and 3.8e-6 at 5 Hz: an error of the coefficients' sums shows.
  for (const double frequency : {200.0, 50.0, 20.0, 5.0})
    for (const double x : {40.0, 1.0, 3 * bit}) {
      const machine::NotchParameters notch{frequency, 0.05, 0.7};
      EXPECT_NEAR(settled<Fix>(notch, x), x, bit) << frequency << " Hz, " << x << " A";
    }
}

TEST(Notch, OfALowFrequencyFollowsTheSmallestStepsAndReturnsToZero) {
  NotchFilter<Fix> filter(low);
  // Without the carried remainder a 50 Hz filter would stand still within 1 / (1 + a1 + a2) / 2 = 1300 bits.
  for (int step = 1; step <= 3; ++step) {
    double y = 0.0;
    for (int k = 0; k < 16000; ++k) y = filter.step(step * bit);
    EXPECT_NEAR(y, step * bit, bit) << step;
  }
  double largest = 0.0;
  for (int k = 0; k < 32000; ++k) {
    const double y = filter.step(0.0);
    if (k >= 16000) largest = std::max(largest, std::abs(y));
  }
  EXPECT_LE(largest, bit) << "no limit cycle is left";
}

TEST(Notch, TheMeanOfItsOutputIsExactBelowOneBit) {
  // A slow ramp of inputs: the mean over a second follows within a small part of a bit, as the remainder is carried.
  for (const std::int32_t bits : {1, 2, 5, 100}) {
    NotchFilter<Fix> filter(low);
    double sum = 0.0;
    for (int k = 0; k < 48000; ++k) {
      const double y = filter.step(bits * bit);
      if (k >= 32000) sum += y;
    }
    EXPECT_NEAR(sum / 16000.0, bits * bit, 0.01 * bit * bits + 0.001 * bit) << bits;
  }
}

TEST(Notch, DisabledLetsEverythingPass) {
  Notch<Fix>::State state;
  SaturationCounter saturations;
  for (const std::int32_t raw : {1, -77, INT32_MAX, INT32_MIN})
    EXPECT_EQ(Notch<Fix>::step({}, state, Fixed<20>::from_raw(raw), saturations).raw(), raw);
}

TEST(Notch, SaturatesAtItsFormatsEndCountsItOnceATickAndComesBack) {
  NotchFilter<Fix> filter(cross_table);
  // A full-range square wave overshoots the format.
  for (int k = 0; k < 200; ++k) {
    const auto before = filter.saturations.count;
    const double y = filter.step(k / 10 % 2 ? -2047.0 : 2047.0);
    ASSERT_LE(std::abs(y), 2048.0);
    ASSERT_LE(filter.saturations.count, before + 1);
    const bool inside = std::abs(y) < 2047.99;
    ASSERT_TRUE(!inside || filter.saturations.count == before) << k;
  }
  EXPECT_GT(filter.saturations.count, 0u);
  double y = 0.0;
  for (int k = 0; k < 2000; ++k) y = filter.step(1.0);
  EXPECT_NEAR(y, 1.0, bit);
}

RC_GTEST_PROP(Notch, FixedPointFollowsDoubleWithinItsRounding, ()) {
  NotchFilter<Fix> fixed(cross_table);
  NotchFilter<Dbl> real(cross_table);
  // The impulse responses of 1/A and (1 - 1/z)/A have the absolute sums 2.91 and 2.13 (scipy.signal.lfilter): five
  // coefficient errors of 2^-29 on 110 A enter through the one, the carried half bits through the other.
  const double bound = 2.91 * 5 * 0x1p-29 * 110.0 + 2.14 * 0.5 * bit;
  for (int n = 0; n < 300; ++n) {
    const double x = bit * static_cast<double>(test::drawn_between(-100 << 20, 100 << 20));
    RC_ASSERT(std::abs(fixed.step(x) - real.step(x)) <= bound);
  }
}

}  // namespace
}  // namespace stiction
