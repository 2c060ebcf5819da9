// Endless axes against exact 128-bit arithmetic: floor and remainder of the whole way by one division, which the steps
// do not know.
#include "stiction/motion/endless_phase.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/firmware/number/exact.hpp"
#include "tests/support/figure.hpp"

namespace stiction {
namespace {

using test::Int128;
using Phase = EndlessPhase;

struct Exact {
  Int128 turns, rest;
};

// Of a way of `counts` from zero, where a turn has numerator / denominator of them.
Exact exact(Int128 counts, std::int64_t numerator, std::int64_t denominator) {
  const Int128 parts = counts * denominator;
  Int128 turns = parts / numerator, rest = parts % numerator;
  if (rest < 0) {
    rest += numerator;
    --turns;
  }
  return {turns, rest};
}

void expect_at(const Phase::State& state, Int128 counts, std::int64_t numerator, std::int64_t denominator) {
  const auto truth = exact(counts, numerator, denominator);
  EXPECT_EQ(test::text(state.turns), test::text(truth.turns));
  EXPECT_EQ(test::text(static_cast<Int128>(state.rest)), test::text(truth.rest));
}

constexpr std::int64_t counts_a_motor_turn = 10000;                               // 2500 lines, four edges each
constexpr std::int64_t numerator = 355 * counts_a_motor_turn, denominator = 113;  // counts a turn of the axis
constexpr Phase::Config table = Phase::config(numerator, denominator);

static_assert(table.near == 62830);
static_assert([] {  // usable while compiling, and so free of what is not defined
  Phase::State state;
  Phase::step(table, state, -1);
  return state.turns == -1 && state.rest == 3550000 - 113 && Phase::phase(table, state) == 0xfffde9f6;
}());

// A turn of the axis at a time, which the encoder sees as 31415 or 31416 counts: as many as end the turn.
void turn_by_turn(Phase::State& state, std::int64_t turns, int direction) {
  std::int64_t left = 0;  // 1/113 count between the last count and the end of the turn
  for (std::int64_t k = 0; k < turns; ++k) {
    std::int64_t counts = 31415;
    left += 105;  // 3550000 = 31415 * 113 + 105
    if (left >= 113) {
      left -= 113;
      ++counts;
    }
    Phase::step(table, state, direction * counts);
  }
}

TEST(EndlessPhase, ABillionTurnsForthAndBackLeaveNoDrift) {
  constexpr std::int64_t turns = 1'000'000'000;
  Phase::State state;
  turn_by_turn(state, turns, 1);
  // 10^9 turns of the axis are 31415929203539.82 counts: the encoder stands 93/113 of a count before them.
  expect_at(state, 31415929203539, numerator, denominator);
  EXPECT_EQ(state.turns, turns - 1);
  EXPECT_EQ(state.rest, 3550000u - 93u);
  turn_by_turn(state, turns, -1);
  const auto drift = static_cast<std::int64_t>(state.rest) + state.turns * numerator;  // in 1/113 counts
  test::figure("endless axis, ratio 355/113, 1e9 turns forth and back: drift",
               fmt::format("{} of 1/113 count (bound 0)", drift));
  EXPECT_EQ(state, Phase::State{});
}

// 355 motor turns are 113 turns of the axis, whatever was before.
TEST(EndlessPhase, MotorTurnsEndWhereTheRatioSays) {
  Phase::State state;
  Phase::step(table, state, 4711);
  const auto begin = state;
  for (int k = 0; k < 355; ++k) {
    Phase::step(table, state, counts_a_motor_turn);
    expect_at(state, 4711 + (k + 1) * counts_a_motor_turn, numerator, denominator);
  }
  EXPECT_EQ(state.turns, begin.turns + 113);
  EXPECT_EQ(state.rest, begin.rest);
}

// Any turn that can be kept, with large and small numbers alike.
struct WholeTurn {
  std::int64_t numerator, denominator;
};
rc::Gen<std::int64_t> of_any_size(int most_bits) {
  return rc::gen::mapcat(rc::gen::inRange(0, most_bits), [](int bits) {
    return rc::gen::inRange<std::int64_t>(std::int64_t{1} << bits, (std::int64_t{1} << bits) * 2);
  });
}
rc::Gen<WholeTurn> turns() {
  return rc::gen::map(rc::gen::pair(of_any_size(62), of_any_size(62)), [](const auto& both) {
    return WholeTurn{std::max(both.first, both.second), std::min(both.first, both.second)};
  });
}
rc::Gen<std::int64_t> ways() {
  return rc::gen::map(rc::gen::pair(of_any_size(62), rc::gen::arbitrary<bool>()),
                      [](const auto& both) { return both.second ? -both.first : both.first; });
}

RC_GTEST_PROP(EndlessPhase, AnyWayIsExact, ()) {
  const auto turn = *turns();
  RC_ASSERT(Phase::can_keep(turn.numerator, turn.denominator));
  const auto config = Phase::config(turn.numerator, turn.denominator);
  Phase::State state;
  Int128 total = 0;
  for (int k = 0; k < 8; ++k) {
    const auto way = *ways();
    const Int128 next = total + way;
    // Turns have 64 bits with sign, the product of the oracle 127.
    if (next > std::numeric_limits<std::int64_t>::max() || next < std::numeric_limits<std::int64_t>::min()) continue;
    total = next;
    Phase::step(config, state, way);
    const auto truth = exact(total, turn.numerator, turn.denominator);
    RC_ASSERT(state.turns == truth.turns);
    RC_ASSERT(static_cast<Int128>(state.rest) == truth.rest);
  }
}

// Two ways and their sum end at one place; a way back undoes the way forth to the bit.
RC_GTEST_PROP(EndlessPhase, TheEndOfAWayIsThatOfItsParts, ()) {
  const auto turn = *turns();
  const auto config = Phase::config(turn.numerator, turn.denominator);
  const std::int64_t first = *ways() / 2, second = *ways() / 2;
  Phase::State parts, whole;
  Phase::step(config, parts, first);
  Phase::step(config, parts, second);
  Phase::step(config, whole, first + second);
  RC_ASSERT(parts == whole);
  Phase::step(config, parts, -second);
  Phase::step(config, parts, -first);
  RC_ASSERT(parts == Phase::State{});
}

RC_GTEST_PROP(EndlessPhase, ThePhaseIsTheRestRoundedDown, ()) {
  const auto turn = *turns();
  const auto config = Phase::config(turn.numerator, turn.denominator);
  Phase::State state;
  Phase::step(config, state, *ways());
  const auto before = state;
  const auto truth = (static_cast<Int128>(state.rest) << 32) / turn.numerator;
  RC_ASSERT(Phase::phase(config, state) == truth);
  RC_ASSERT(state == before);
}

TEST(EndlessPhase, TheFarthestWaysAreExact) {
  constexpr auto lowest = std::numeric_limits<std::int64_t>::min(), highest = std::numeric_limits<std::int64_t>::max();
  for (const auto& turn : {WholeTurn{numerator, denominator}, WholeTurn{1, 1}, WholeTurn{Phase::largest, 1},
                           WholeTurn{Phase::largest, Phase::largest}, WholeTurn{Phase::largest, Phase::largest - 1}}) {
    const auto config = Phase::config(turn.numerator, turn.denominator);
    for (const auto way : {lowest, highest, std::int64_t{1}, std::int64_t{-1}}) {
      Phase::State state;
      Phase::step(config, state, way);
      expect_at(state, way, turn.numerator, turn.denominator);
    }
  }
}

TEST(EndlessPhase, TurnsThatCannotBeKeptAreKnown) {
  EXPECT_TRUE(Phase::can_keep(numerator, denominator));
  EXPECT_TRUE(Phase::can_keep(Phase::largest, 1));
  EXPECT_FALSE(Phase::can_keep(std::numeric_limits<std::int64_t>::max(), 1));
  EXPECT_FALSE(Phase::can_keep(112, 113));  // not a count a turn
  EXPECT_FALSE(Phase::can_keep(0, 1));
  EXPECT_FALSE(Phase::can_keep(5, 0));
  EXPECT_FALSE(Phase::can_keep(-5, -2));
}

}  // namespace
}  // namespace stiction
