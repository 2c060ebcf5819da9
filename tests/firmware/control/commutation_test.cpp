// Three-phase commutation: the force of the commutated currents does not depend on the position.
#include "stiction/control/commutation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/control/limit.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using C = Commutation<S>;
using R = Commutation<machine::DoubleSignals>;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double third = two_pi / 3.0;
constexpr double bit_i = 0x1p-20;

double angle_of(std::uint32_t raw) { return two_pi * static_cast<double>(raw) * 0x1p-32; }

// The force of phase currents in a motor of K_F = 1 (Mendricky 2006, 3.6), from the angle itself.
double force(const std::array<double, 3>& current, double angle) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += current[k] * std::sin(angle + static_cast<double>(k) * third);
  return sum;
}

TEST(Commutation, ForceIsThreeHalvesOfTheAmplitudeAtEveryPosition) {
  SaturationCounter saturations;
  const auto amplitude = machine::to_signal<S::Current>(40.0).value();
  for (std::uint64_t raw = 0; raw < (std::uint64_t{1} << 32); raw += 4294967) {
    const auto turn = Turn{static_cast<std::uint32_t>(raw)};
    const auto phase = C::phases(turn);
    std::array<double, 3> current;
    const auto set = C::phase_currents(amplitude, phase, saturations);
    for (std::size_t k = 0; k < 3; ++k) current[k] = machine::to_si(set[k]);
    // Sines within 6e-9 of 40 A (the third within twice that), half a bit for two currents, one for the third.
    ASSERT_NEAR(force(current, angle_of(turn.raw)), 1.5 * 40.0, 40.0 * 4 * 6e-9 + 2.0 * bit_i) << raw;
  }
}

TEST(Commutation, PhasesAreAThirdOfATurnApartAndSumToZero) {
  for (std::uint64_t raw = 0; raw < (std::uint64_t{1} << 32); raw += 1234567) {
    const auto turn = Turn{static_cast<std::uint32_t>(raw)};
    const auto phase = C::phases(turn);
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(machine::to_si(phase[k]), std::sin(angle_of(turn.raw) + static_cast<double>(k) * third), 2 * 6e-9);
    // Exactly, but for an output clamped at 1: by the 12e-9 that the sum of two sines can be off.
    ASSERT_LE(std::abs(phase[0].raw() + phase[1].raw() + phase[2].raw()), 13);
  }
}

TEST(Commutation, SaturatesNothingAtAnyAngle) {
  // A saturation is counted as something out of the ordinary; commutation at a peak of a phase is not.
  SaturationCounter saturations;
  for (std::int64_t peak : {std::int64_t{1} << 30, std::int64_t{3} << 30})
    for (std::int64_t d = -200000; d <= 200000; d += 7)
      for (std::uint32_t k = 0; k < 3; ++k) C::phases(Turn{static_cast<std::uint32_t>(peak + d) - k * 0x55555555u});
  EXPECT_EQ(saturations.count, 0u);
}

RC_GTEST_PROP(Commutation, AmplitudeInvertsThePhaseCurrents, ()) {
  SaturationCounter saturations;
  const auto turn = Turn{static_cast<std::uint32_t>(test::drawn_between(0, UINT32_MAX))};
  const auto amplitude = S::Current::from_raw(static_cast<std::int32_t>(test::drawn_between(INT32_MIN, INT32_MAX)));
  const auto phase = C::phases(turn);
  const auto current = C::phase_currents(amplitude, phase, saturations);
  const double back = machine::to_si(C::amplitude(current, phase, saturations));
  const double exact = machine::to_si(amplitude);
  // 2/3 of: half a bit of two currents and a bit of the third weighted by |sin| (1.5 at most together) and the sum's
  // own of 2^-20 A; then the last half. The sines' 6e-9 in a^2 + b^2 + (a+b)^2 are at most 2/3 * 2 * sqrt(3) * 6e-9 of
  // the amplitude in each of a and b.
  RC_ASSERT(std::abs(back - exact) <= 2.2 * bit_i + 3e-8 * std::abs(exact));
}

RC_GTEST_PROP(Commutation, AmplitudeOfAnyCurrentsIsTwoThirdsOfTheirForce, ()) {
  SaturationCounter saturations;
  const auto turn = Turn{static_cast<std::uint32_t>(test::drawn_between(0, UINT32_MAX))};
  std::array<S::Current, 3> current;
  std::array<double, 3> si;
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    current[k] = S::Current::from_raw(static_cast<std::int32_t>(test::drawn_between(-1000000000, 1000000000)));
    si[k] = machine::to_si(current[k]);
    largest = std::max(largest, std::abs(si[k]));
  }
  const double found = machine::to_si(C::amplitude(current, C::phases(turn), saturations));
  RC_ASSERT(std::abs(found - 2.0 / 3.0 * force(si, angle_of(turn.raw))) <= 2 * bit_i + 4 * 6e-9 * largest);
}

TEST(Commutation, OfTheLargestCurrentsNeitherOverflowsNorLosesItsSign) {
  SaturationCounter saturations;
  const auto turn = Turn{1u << 30};  // phases 1, -1/2, -1/2
  const auto phase = C::phases(turn);
  const std::array<S::Current, 3> largest{Fixed<20>::from_raw(INT32_MAX), Fixed<20>::from_raw(INT32_MIN),
                                          Fixed<20>::from_raw(INT32_MIN)};
  EXPECT_NEAR(machine::to_si(C::amplitude(largest, phase, saturations)), 2.0 / 3.0 * 2.0 * 2048.0, 700.0)
      << "2731 A, saturated to 2048 A";
  EXPECT_GE(saturations.count, 1u);
}

TEST(Commutation, InDoubleIsExactToItsRounding) {
  SaturationCounter saturations;
  for (double angle = -20.0; angle < 20.0; angle += 0.0137) {
    const auto phase = R::phases({angle});
    std::array<machine::Real, 3> current;
    std::array<double, 3> si;
    for (std::size_t k = 0; k < 3; ++k) {
      current[k] = R::phase_currents({40.0}, phase, saturations)[k];
      si[k] = current[k].value;
    }
    ASSERT_NEAR(force(si, angle), 60.0, 1e-12);
    ASSERT_NEAR(R::amplitude(current, phase, saturations).value, 40.0, 1e-12);
  }
}

TEST(Limit, HoldsAtItsEndsAndTellsWhichOneActed) {
  using T = Fixed<4>;
  const auto at = [](std::int32_t raw) { return limit(T::from_raw(raw), T::from_raw(70)); };
  for (const std::int32_t inside : {70, 69, 0, -69, -70}) {
    EXPECT_EQ(at(inside).value.raw(), inside);
    EXPECT_FALSE(at(inside).limiting()) << "at the limit is not behind it";
    EXPECT_EQ(at(inside).side, 0);
  }
  for (const std::int32_t above : {71, 1000, INT32_MAX}) {
    EXPECT_EQ(at(above).value.raw(), 70);
    EXPECT_TRUE(at(above).limiting());
    EXPECT_EQ(at(above).side, 1);
  }
  for (const std::int32_t below : {-71, -1000, INT32_MIN}) {
    EXPECT_EQ(at(below).value.raw(), -70);
    EXPECT_EQ(at(below).side, -1);
  }
}

}  // namespace
}  // namespace stiction
