// The phase of an endless axis from the counts of an encoder, exact for ever. An encoder with C counts a turn of the
// motor, behind a ratio of p motor turns to q turns of the axis, gives C p / q counts a turn of the axis: a fraction
// that no number of counts equals, so that whoever adds up a rounded turn drifts. What is kept is therefore whole turns
// and the rest in q-ths of a count, of which a turn has C p, a whole number: nothing is rounded, whatever the way.
//
// Integers alone; a step has fixed work on either of its two paths and no division.
#pragma once

#include <cstdint>

namespace stiction {

class EndlessPhase {
 public:
  // Of both numbers of a turn. A rest, doubled and with one more count, then still fits into 64 bits.
  static constexpr std::int64_t largest = std::int64_t{1} << 62;

  // The counts in a turn of the axis, numerator / denominator. The default is one count a turn.
  struct Config {
    std::uint64_t turn = 1;   // numerator: parts of a count in a turn
    std::uint64_t count = 1;  // denominator: parts in a count
    std::uint64_t near = 2;   // counts: no more than two turns

    friend constexpr bool operator==(const Config&, const Config&) = default;
  };

  struct State {
    std::int64_t turns = 0;  // whole turns of the axis, towards minus infinity
    std::uint64_t rest = 0;  // beyond them, in parts of a count: 0 to turn - 1

    friend constexpr bool operator==(const State&, const State&) = default;
  };

  // Whether a turn of numerator / denominator counts can be kept: 1 <= denominator <= numerator <= 2^62, so that there
  // is a count in every turn.
  static constexpr bool can_keep(std::int64_t numerator, std::int64_t denominator) {
    return denominator >= 1 && denominator <= numerator && numerator <= largest;
  }

  // `numerator`, `denominator`: counts in a turn of the axis, which can_keep() holds; in any terms. For C counts a
  // motor turn and a ratio of p/q they are C p and q.
  static constexpr Config config(std::int64_t numerator, std::int64_t denominator) {
    const auto turn = static_cast<std::uint64_t>(numerator), count = static_cast<std::uint64_t>(denominator);
    return {turn, count, 2 * (turn / count)};
  }

  // Moves `state` by `counts`, any number of either sign. Whole turns count around beyond 2^63, which no way of fewer
  // counts reaches. A step of up to two turns, as every tick has it, is one product and two comparisons; a longer one
  // goes bit by bit. `config`: of the axis.
  static constexpr void step(const Config& config, State& state, std::int64_t counts) {
    const bool back = counts < 0;
    const auto size = back ? -static_cast<std::uint64_t>(counts) : static_cast<std::uint64_t>(counts);
    const Way way = size <= config.near ? near(config, size) : far(config, size);
    if (back)
      move_back(config, state, way);
    else
      move_on(config, state, way);
  }

  // The part of a turn beyond the whole ones of `state` in 2^-32 turns, rounded down: 0 to 2^32 - 1. The rest stays as
  // it is. `config`: of the axis.
  static constexpr std::uint32_t phase(const Config& config, const State& state) {
    std::uint64_t rest = state.rest;
    std::uint32_t phase = 0;
    for (int bit = 0; bit < 32; ++bit) {
      rest *= 2;
      const bool set = rest >= config.turn;
      if (set) rest -= config.turn;
      phase = phase << 1 | static_cast<std::uint32_t>(set);
    }
    return phase;
  }

 private:
  // A way without its sign. `rest`: 0 to a whole turn.
  struct Way {
    std::uint64_t turns = 0, rest = 0;
  };

  static constexpr Way near(const Config& config, std::uint64_t size) {
    const std::uint64_t parts = size * config.count;
    return parts >= config.turn ? Way{1, parts - config.turn} : Way{0, parts};
  }

  // size * count parts, divided by those of a turn with one bit of `size` after the other. A count is at most a turn,
  // and each doubling of a rest below a turn with a count in addition is below three.
  static constexpr Way far(const Config& config, std::uint64_t size) {
    Way way;
    for (int bit = 63; bit >= 0; --bit) {
      way.turns *= 2;
      way.rest = 2 * way.rest + ((size >> bit & 1) != 0 ? config.count : 0);
      for (int twice = 0; twice < 2; ++twice)
        if (way.rest >= config.turn) {
          way.rest -= config.turn;
          ++way.turns;
        }
    }
    return way;
  }

  static constexpr void move_on(const Config& config, State& state, const Way& way) {
    std::uint64_t turns = static_cast<std::uint64_t>(state.turns) + way.turns, rest = state.rest + way.rest;
    if (rest >= config.turn) {
      rest -= config.turn;
      ++turns;
    }
    state = {static_cast<std::int64_t>(turns), rest};
  }

  static constexpr void move_back(const Config& config, State& state, const Way& way) {
    std::uint64_t turns = static_cast<std::uint64_t>(state.turns) - way.turns, rest = state.rest;
    if (rest < way.rest) {
      rest += config.turn;
      --turns;
    }
    state = {static_cast<std::int64_t>(turns), rest - way.rest};
  }
};

}  // namespace stiction
