// The operations of the firmware's signal policy that depend on its formats: time in ticks and seconds, the split of a
// delay, and the electrical angle.
#include "stiction/number/fixed_signals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using test::Int128;

constexpr int period_ns = 62500;
constexpr auto inverse_period = S::PeriodInverse::from_raw(562949953);  // 2^45 / 62500 = 562949953.42
constexpr std::int32_t one_tick = 1 << S::Ticks::fraction_bits;

TEST(Ticks, OfWholeAndHalfPeriodsAreWithinTheRoundingOfTheInverse) {
  // The inverse is rounded by less than half of 2^-45 / ns: 0.43 * 62500 ns * 2^-17 = 0.2 of the last bit per tick.
  for (const int half_ticks : {0, 1, 2, 3, 4, 7})
    EXPECT_NEAR(S::ticks(half_ticks * period_ns / 2, inverse_period).raw(), half_ticks * (one_tick / 2), 1)
        << half_ticks;
}

TEST(Ticks, SaturateBeyondEight) {
  EXPECT_NEAR(S::ticks(std::int64_t{5} * period_ns, inverse_period).raw(), 5 * one_tick, 2);
  EXPECT_EQ(S::ticks(INT64_MAX, inverse_period).raw(), INT32_MAX) << "eight ticks";
  EXPECT_EQ(S::ticks(INT64_MIN, inverse_period).raw(), INT32_MIN);
}

RC_GTEST_PROP(Ticks, AreTheNearestValueOfTheProduct, ()) {
  const auto duration = test::drawn_between(-10 * period_ns, 10 * period_ns);
  RC_ASSERT(std::int64_t{S::ticks(duration, inverse_period).raw()} ==
            test::expected_raw<S::Ticks>(Int128{duration} * inverse_period.raw(), 45));
}

TEST(Split, SeparatesWholeTicksFromTheRest) {
  const auto split = [](double ticks) {
    return S::split(S::Ticks::from_raw(static_cast<std::int32_t>(std::lround(ticks * one_tick))), 3);
  };
  EXPECT_EQ(split(0.0).whole, 0);
  EXPECT_EQ(split(0.0).fraction.raw(), 0);
  EXPECT_EQ(split(0.5).whole, 0);
  EXPECT_EQ(split(0.5).fraction.raw(), one_tick / 2);
  EXPECT_EQ(split(1.0).whole, 1);
  EXPECT_EQ(split(1.0).fraction.raw(), 0);
  EXPECT_EQ(split(3.75).whole, 3);
  EXPECT_EQ(split(3.75).fraction.raw(), one_tick / 4 * 3);
  EXPECT_EQ(split(4.0).whole, 3) << "four ticks are the whole last interval";
  EXPECT_EQ(split(4.0).fraction.raw(), one_tick);
  EXPECT_EQ(split(-1.0).whole, 0) << "delays below zero read the newest";
  EXPECT_EQ(split(-1.0).fraction.raw(), 0);
}

TEST(Split, BeyondItsHighestTickReadsTheEnd) {
  const auto split = S::split(S::Ticks::from_raw(3 * one_tick), 1);
  EXPECT_EQ(split.whole, 1);
  EXPECT_EQ(split.fraction.raw(), one_tick);
}

TEST(Seconds, AreWithinTheRoundingOfTheNanosecond) {
  // 1e-9 s is held in 2^-50 s with a relative error of 8e-8; the result rounds to 2^-36 s = 15 ps.
  for (const std::int64_t ns : {0, 1, 500, 31250, 62500, 125000, 900000, 15000000, -62500}) {
    const double exact = std::ldexp(1e-9 * static_cast<double>(ns), 36);
    EXPECT_NEAR(S::seconds(ns).raw(), exact, 0.5 + 1e-7 * std::abs(exact)) << ns << " ns";
  }
}

TEST(Seconds, SaturateBeyondThirtyOneMilliseconds) {
  EXPECT_EQ(S::seconds(15624000).raw(), test::nearest(Int128{15624000} * 1125900, 1 << 14));
  EXPECT_EQ(S::seconds(32000000).raw(), INT32_MAX);
  EXPECT_EQ(S::seconds(INT64_MIN).raw(), INT32_MIN);
}

// Turns of `position` by exact division of the raw words, in 2^-32 turns, wrapped.
std::uint32_t exact_turn(std::int64_t position_raw, std::int32_t inverse_pitch_raw) {
  const Int128 turns = Int128{position_raw} * inverse_pitch_raw;  // 60 fraction bits
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(turns >> 28));
}

RC_GTEST_PROP(ElectricalAngle, WrapsWholeTurnsAndIsTruncatedByLessThanTheAngleOfAPositionBit, ()) {
  const auto position = test::drawn<S::Position>();
  const auto inverse = S::PitchInverse::from_raw(static_cast<std::int32_t>(test::drawn_between(1, 1 << 30)));
  // Eight bits of the position are cut, less than 2^-32 m: inverse pitch * 2^-32 m of a turn, and one bit of the angle.
  const auto late =
      static_cast<std::int32_t>(exact_turn(position.raw(), inverse.raw()) - S::angle(position, inverse).raw);
  RC_ASSERT(late >= 0);
  RC_ASSERT(Int128{late} <= (Int128{inverse.raw()} >> S::PitchInverse::fraction_bits) + 2);
}

TEST(ElectricalAngle, AdvancesByATurnPerPitchInBothDirections) {
  const auto inverse = S::PitchInverse::from_raw(16 << 20);  // pitch 1/16 m, exact
  const auto at = [&](double metres) {
    return S::angle(S::Position::from_raw(std::llround(std::ldexp(metres, 40))), inverse).raw;
  };
  EXPECT_EQ(at(0.0), 0u);
  EXPECT_EQ(at(1.0 / 64.0), 1u << 30);
  EXPECT_EQ(at(1.0 / 16.0), 0u);
  EXPECT_EQ(at(-1.0 / 64.0), 3u << 30);
  EXPECT_EQ(at(-10.0 + 1.0 / 64.0), 1u << 30);
}

TEST(ElectricalAngle, ThreeThirdsOfATurnAreATurn) {
  Turn turn{12345u};
  for (int i = 0; i < 3; ++i) turn = S::third_of_turn_after(turn);
  EXPECT_LE(12345u - turn.raw, 1u);  // 3 * 0x55555555 is one short of 2^32
}

}  // namespace
}  // namespace stiction
