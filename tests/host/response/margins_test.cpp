// Margins of loops whose margins are known in closed form.
#include "host/response/margins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stiction::test {
namespace {

using host::Curve;

// 50 points in a decade, as the test signals have them.
template <class Loop>
Curve curve(double low, double high, Loop&& loop) {
  Curve result;
  for (double f = low; f < high; f *= std::pow(10.0, 0.02))
    result.add(f, loop(std::complex<double>(0.0, 2.0 * std::numbers::pi * f)));
  return result;
}

// K/(s (1 + s T)^2): -180 deg at w = 1/T, where the magnitude is K T/2.
constexpr double T = 1e-3, K = 200.0;
std::complex<double> third_order(std::complex<double> s) { return K / (s * (1.0 + s * T) * (1.0 + s * T)); }

TEST(Margins, OfAThirdOrderLoopAreThoseOfItsFormula) {
  const auto open = curve(1.0, 5000.0, third_order);
  const auto gain = gain_margin(open);
  ASSERT_TRUE(gain);
  EXPECT_NEAR(gain->factor, 2.0 / (K * T), 0.002 * gain->factor);  // straight between points of 5 %
  EXPECT_NEAR(gain->frequency, 1.0 / (2.0 * std::numbers::pi * T), 0.5);
  const auto phase = phase_margin(open);
  ASSERT_TRUE(phase);
  // w (1 + w^2 T^2) = K
  double w = K;
  for (int k = 0; k < 50; ++k) w = K / (1.0 + w * w * T * T);
  EXPECT_NEAR(phase->frequency, w / (2.0 * std::numbers::pi), 0.1);
  EXPECT_NEAR(phase->degrees, 90.0 - 2.0 * std::atan(w * T) * 180.0 / std::numbers::pi, 0.1);
}

TEST(Margins, ALoopThatNeverTurnsByHalfACircleHasNoGainMargin) {
  const auto open = curve(1.0, 1000.0, [](auto s) { return 100.0 / s; });
  EXPECT_FALSE(gain_margin(open));
  EXPECT_NEAR(phase_margin(open)->degrees, 90.0, 1e-6);
}

TEST(Margins, AResonanceFarFromMinusOneTakesNothingFromThePhaseMargin) {
  // K w0^2/(s (s^2 + 2 D w0 s + w0^2)), and a dead time with which the resonance comes at -360 deg: the loop crosses
  // magnitude 1 there twice more, at -300 and at -420 deg, more than 90 deg away from -180 deg on either side.
  constexpr double gain = 120.0, w0 = 2.0 * std::numbers::pi * 100.0, damping = 0.05;
  const double dead = std::numbers::pi / w0;
  const auto open = curve(1.0, 1000.0, [&](std::complex<double> s) {
    return gain * w0 * w0 / (s * (s * s + 2.0 * damping * w0 * s + w0 * w0)) * std::exp(-s * dead);
  });
  // |L| = 1 far below w0: w (1 - w^2/w0^2) = K but for the damping.
  double w = gain;
  for (int k = 0; k < 50; ++k) w = gain / (1.0 - w * w / (w0 * w0));
  const double lag = w * dead + std::atan2(2.0 * damping * w / w0, 1.0 - w * w / (w0 * w0));
  const auto phase = phase_margin(open);
  ASSERT_TRUE(phase);
  EXPECT_NEAR(phase->frequency, w / (2.0 * std::numbers::pi), 0.1);
  EXPECT_NEAR(phase->degrees, 90.0 - lag * 180.0 / std::numbers::pi, 0.5);
}

TEST(Margins, ACrossingAboveOneIsALowerLimitAndNotTheMargin) {
  // -180 deg at a low frequency with a large magnitude, and again, with a dead time, at a high one.
  const auto open = curve(
      0.5, 5000.0, [](auto s) { return 4e5 * (s + 30.0) * (s + 30.0) / (s * s * s * 1e3) * std::exp(-s * 5e-4); });
  const auto gain = gain_margin(open);
  ASSERT_TRUE(gain);
  EXPECT_GT(gain->factor, 1.0);
  EXPECT_GT(gain->frequency, 100.0);
}

TEST(Margins, BandwidthIsWhereAFirstOrderLoopFallsBelowMinusThreeDecibel) {
  const auto closed = curve(1.0, 5000.0, [](auto s) { return 1.0 / (1.0 + s / 600.0); });
  EXPECT_NEAR(*bandwidth(closed), 600.0 / (2.0 * std::numbers::pi), 0.2);
  EXPECT_FALSE(bandwidth(curve(1.0, 50.0, [](auto s) { return 1.0 / (1.0 + s / 600.0); })));
}

// The characteristic polynomial of K f/(s (1 + s T)^2) with a pair of roots at s = -d +- j w: in s = p - d it is
// T^2 p^3 + (2T - 3T^2 d) p^2 + (1 - 4T d + 3T^2 d^2) p + ..., whose limit is that of Hurwitz.
TEST(Margins, WithDecayTheGainMarginIsThatOfTheShiftedAxis) {
  constexpr double d = 20.0;
  const double a3 = T * T, a2 = 2 * T - 3 * T * T * d, a1 = 1 - 4 * T * d + 3 * T * T * d * d;
  const double a0_limit = a1 * a2 / a3;  // a0 = K f - d + 2 T d^2 - T^2 d^3
  const double factor = (a0_limit + d - 2 * T * d * d + T * T * d * d * d) / K;
  const auto gain = gain_margin(with_decay(curve(1.0, 5000.0, third_order), d));
  ASSERT_TRUE(gain);
  EXPECT_NEAR(gain->factor / factor, 1.0, 0.005);  // first order in d
}

}  // namespace
}  // namespace stiction::test
