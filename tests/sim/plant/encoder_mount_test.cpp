// The encoder's elastic mount (Mendricky 2006, 3.15-3.18) in time and in frequency.
#include "sim/plant/encoder_mount.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "firmware/machine/file/parameters.hpp"

namespace stiction::sim {
namespace {

constexpr machine::EncoderMountParameters cross_table{0.5, 2000.0, 0.05};
constexpr double two_pi = 2.0 * std::numbers::pi;

TEST(EncoderMountParameters, WithoutParametersIsRigid) {
  EncoderMountModel mount(std::nullopt, 1e-5);
  for (int i = 0; i < 10; ++i) mount.advance(0.1);
  EXPECT_EQ(mount.deflection(), 0.0);
  EXPECT_EQ(mount.velocity(), 0.0);
}

TEST(EncoderMountParameters, SwingsIntoAHeldAccelerationByTheClosedFormInAnyStep) {
  constexpr double a = 20.0;
  const double w = two_pi * 2000.0, decay = 0.05 * w, damped = w * std::sqrt(1.0 - 0.05 * 0.05);
  for (const double h : {1e-6, 15.625e-6, 1e-4, 3e-4}) {
    EncoderMountModel mount(cross_table, h);
    for (int n = 1; n <= 200; ++n) {
      mount.advance(a * h);
      const double t = n * h, e = std::exp(-decay * t);
      const double expected = -a / (w * w) * (1.0 - e * (std::cos(damped * t) + decay / damped * std::sin(damped * t)));
      // Static deflection 0.127 um; some 1e-14 of it per step from rounding.
      ASSERT_NEAR(mount.deflection(), expected, 1e-12 * a / (w * w) * 100) << h << ", " << n;
      ASSERT_NEAR(mount.velocity(), -a / damped * e * std::sin(damped * t), 1e-10 * a / w) << h << ", " << n;
    }
  }
}

TEST(EncoderMountParameters, InFrequencyIsTheTransferFunctionOfItsEquation) {
  // (3.16): X_j / X = (b s + k) / (m s^2 + b s + k), k = w^2 m, b = 2 zeta sqrt(k m). The model's input is the
  // acceleration; x and x_j follow from it: X_j / X = 1 + D / X, X = A / s^2.
  constexpr double m = 0.5;
  const double k = std::pow(two_pi * 2000.0, 2) * m, b = 2.0 * 0.05 * std::sqrt(k * m);
  constexpr double h = 2e-7;
  for (const double frequency : {100.0, 1000.0, 1900.0, 2000.0, 2500.0, 8000.0}) {
    EncoderMountModel mount(cross_table, h);
    std::complex<double> sum = 0.0;
    const auto period = static_cast<int>(std::lround(1.0 / frequency / h));
    const double omega = two_pi / period;  // per step
    const std::complex<double> s(0.0, omega / h);
    const int settle = 100000 / period * period + period;  // 20 ms, 12 decay constants
    for (int n = 0; n < settle + 4 * period; ++n) {
      mount.advance(std::cos(omega * (n + 0.5)) * h);  // 1 m/s^2 at the step's middle
      if (n >= settle) sum += mount.deflection() * std::polar(1.0, -omega * (n + 1));
    }
    const std::complex<double> d = 2.0 * sum / (4.0 * period);
    const auto found = 1.0 + d * s * s;
    const auto expected = (b * s + k) / (m * s * s + b * s + k);
    // The acceleration is held over steps of 0.2 us: (w h)^2 / 24, 4e-6 at 8 kHz; exp(-12) is left of the start.
    EXPECT_NEAR(std::abs(found - expected), 0.0, 3e-5 * std::max(1.0, std::abs(expected - 1.0))) << frequency << " Hz";
  }
}

TEST(EncoderMountParameters, CriticallyAndOverdampedItStillFollows) {
  // The machine file takes damping ratios up to 10: none may turn the reading into NaN.
  constexpr double a = 20.0;
  const double w = two_pi * 2000.0;
  for (const double damping : {1.0, 1.5, 10.0}) {
    EncoderMountModel mount(machine::EncoderMountParameters{0.5, 2000.0, damping}, 15.625e-6);
    for (int n = 0; n < 6400; ++n) mount.advance(a * 15.625e-6);  // 0.1 s; the slowest constant is 20 / w = 1.6 ms
    EXPECT_NEAR(mount.deflection(), -a / (w * w), 1e-9 * a / (w * w)) << damping;
  }
}

TEST(EncoderMountParameters, UndampedKeepsItsEnergy) {
  EncoderMountModel mount(machine::EncoderMountParameters{0.5, 2000.0, 0.0}, 15.625e-6);
  mount.advance(1e-3);
  const double w = two_pi * 2000.0;
  const auto energy = [&] { return std::pow(mount.velocity(), 2) + std::pow(w * mount.deflection(), 2); };
  const double start = energy();
  ASSERT_GT(start, 0.0);
  for (int n = 0; n < 64000; ++n) mount.advance(0.0);
  EXPECT_NEAR(energy() / start, 1.0, 1e-10) << "a second of free swinging";
}

TEST(EncoderMountParameters, DeflectsByAFiniteAmountAtBothEndsOfTheAllowedNaturalFrequencies) {
  using Mount = machine::Table<machine::EncoderMountParameters>;
  EXPECT_FALSE(Mount::natural_frequencies.contains(1e-323));  // 1 / w^2 is infinite
  for (const double frequency : {Mount::natural_frequencies.low, Mount::natural_frequencies.high}) {
    EncoderMountModel mount(machine::EncoderMountParameters{0.5, frequency, 0.05}, 15.625e-6);
    for (int i = 0; i < 10; ++i) mount.advance(1e-4);
    EXPECT_TRUE(std::isfinite(mount.deflection()) && std::isfinite(mount.velocity())) << frequency << " Hz";
    EXPECT_NE(mount.deflection(), 0.0) << frequency << " Hz";
  }
}

}  // namespace
}  // namespace stiction::sim
