// Learning over laps: a current after each reversal, over the distance since, that adapts from the following error
// (iterative learning control, Arimoto, Kawamura, Miyazaki 1984; with a robustness filter, Bristow, Tharayil, Alleyne
// 2006). It corrects what the friction feedforward leaves, and is a small table for each direction.
//  - Only a reversal after a long way (2 mm) plays and teaches the table: a short one has another past, and there the
//    current of before is held.
//  - What taught: A of missing force, from the error behind a dead zone and from its rate, through a lowpass. It is
//    credited to where the set-point was when that force should have acted. A node takes it as the set-point passes.
//  - Bounded, forgetting, smoothed over neighbours. From one direction's current to the other's it blends over 30 um.
//  - At the first reversal of an octave of acceleration the table is silent: the error then is the reference. Where it
//    grows beyond that, the table is dropped and stays so until the next start.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/delay_line.hpp"
#include "stiction/control/limit.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct GlitchLearning {
  using Current = typename S::Current;
  using Distance = typename S::Distance;
  using Weight = typename S::FilterCoefficient;

  static constexpr std::size_t nodes = S::travel_nodes;
  static constexpr std::uint32_t credit_buffer = 256;  // ticks
  using Table = std::array<Current, nodes>;
  struct Tables {
    Table backward{}, forward{};
  };

  struct Config {
    bool adapt = true;                          // false: the table is played as it is
    typename S::ContactStiffness rate_gain{};   // A per m of change in a tick
    typename S::ContactStiffness error_gain{};  // A/m
    Distance dead_zone{};                       // of the error
    Distance error_limit{};                     // larger errors teach no more than this one
    Weight filter{}, filter_rest{};             // of the newest value, and 1 - filter
    Weight gain{};                              // of what was missing
    Weight keep{};                              // 1 - forgetting - 2 smoothing
    Weight smoothing{};                         // share of each neighbour
    Current limit{};                            // of each node
    std::uint32_t credit_ticks = 0;             // from a set-point to its credit; below credit_buffer - 1
    Distance tolerance{};                       // by which the error may grow above 5/4 of the reference
    std::uint32_t machine = 0;                  // identity of machine and axis; a table of another one is refused
    Tables tables{};                            // at start
    std::uint32_t tables_machine = 0;
  };

  static constexpr std::size_t references = 12;  // octaves of acceleration, from 1/64 m/s^2
  struct State {
    Tables tables{};
    typename S::Position x{};
    typename S::Step travel{};      // since the last reversal; stays at 2 mm
    Current current{};              // played now
    Current before{};               // at the last reversal
    bool forward = false;           // direction of the last motion
    bool full = false;              // the way before the last reversal was a long one
    bool silent = false;            // the table is not played since the last reversal, to take the reference
    bool teaches = false;           // since the last reversal
    std::array<bool, 2> learned{};  // something, by direction
    bool dropped = false;
    std::uint8_t octave = 0;                          // of the acceleration at the last reversal
    DelayLine<std::uint8_t, credit_buffer> passed{};  // where the set-point was: direction and node, 0: not to learn
    Distance error{};                                 // of the tick before
    Current missing{};                                // lowpassed
    Distance peak{};                                  // largest error since the last reversal
    std::array<std::array<Distance, references>, 2> reference{};  // by direction; 0: not taken yet
  };

  // Whether the configured table is of this machine; of another one none is taken.
  static constexpr bool takes(const Config& config) { return config.tables_machine == config.machine; }

  static constexpr State start(const Config& config, typename S::Position x) {
    State state;
    state.x = x;
    if (!takes(config)) return state;
    state.tables = config.tables;
    state.learned = {!is_empty(config.tables.backward), !is_empty(config.tables.forward)};
    return state;
  }

  // The current for the newest set-point. `v`, `a`: its speed and acceleration.
  [[gnu::always_inline]] static constexpr Current play(const Config& config, State& state, typename S::Position x,
                                                       typename S::Velocity v, typename S::Acceleration a,
                                                       SaturationCounter& saturations) {
    const typename S::Velocity rest{};
    const bool forward = v > rest || (state.forward && !(v < rest));
    if (forward != state.forward) reverse(config, state, forward, a);
    const auto dx = narrow<typename S::Step>(x - state.x, saturations);
    state.x = x;
    state.travel = S::add_travel(state.travel, dx);

    const auto [node, fraction] = S::travel_place(state.travel);
    const auto& table = forward ? state.tables.forward : state.tables.backward;
    const std::size_t upper = node + 1 < nodes ? node + 1 : node;
    const auto learned = narrow<Current>(table[node] * S::complement(fraction) + table[upper] * fraction, saturations);
    const bool plays = state.full && !state.silent && !state.dropped;
    const Current at_reversal = plays ? table[0] : Current{};
    const auto jump = saturated_difference(state.before, at_reversal, saturations);
    const auto blended = saturated_sum(plays ? learned : Current{},
                                       narrow<Current>(jump * S::blend(state.travel), saturations), saturations);
    state.current = state.full ? blended : state.before;
    state.passed.push(state.teaches ? static_cast<std::uint8_t>((node + 1) | (forward ? forward_mark : 0u))
                                    : std::uint8_t{0});
    return state.current;
  }

  // Takes the following error of the tick that the axis has just controlled.
  [[gnu::always_inline]] static constexpr void learn(const Config& config, State& state, Distance e,
                                                     SaturationCounter& saturations) {
    const Distance none{};
    const Distance magnitude = e < none ? opposite(e) : e;
    state.peak = magnitude > state.peak ? magnitude : state.peak;

    const auto change = clamped(saturated_difference(e, state.error, saturations), config.error_limit);
    state.error = e;
    const auto in_zone = clamped(e, config.dead_zone);
    const auto beyond = clamped(saturated_difference(e, in_zone, saturations), config.error_limit);
    const auto raw = narrow<Current>(config.rate_gain * change + config.error_gain * beyond, saturations);
    state.missing = narrow<Current>(config.filter * raw + config.filter_rest * state.missing, saturations);

    const std::uint8_t now = state.passed.at(config.credit_ticks);
    const std::uint8_t last = state.passed.at(config.credit_ticks + 1);
    // Worked out in every tick, kept where the set-point came to another node.
    const bool passes = now != 0 && now != last && config.adapt && !state.dropped;
    auto& table = (now & forward_mark) != 0 ? state.tables.forward : state.tables.backward;
    const std::size_t place = now & (forward_mark - 1u);
    const std::size_t node = place > 0 ? place - 1 : 0;
    const std::size_t lower = node > 0 ? node - 1 : node, upper = node + 1 < nodes ? node + 1 : node;
    const auto taught = clamped(narrow<Current>(config.keep * table[node] + config.gain * state.missing +
                                                    config.smoothing * table[lower] + config.smoothing * table[upper],
                                                saturations),
                                config.limit);
    table[node] = passes ? taught : table[node];
    auto& learned = state.learned[(now & forward_mark) != 0];
    learned = learned || passes;
  }

 private:
  static constexpr unsigned forward_mark = 64;
  static_assert(nodes < forward_mark);

  static constexpr bool is_empty(const Table& table) {
    bool empty = true;
    for (const auto& current : table) empty = empty && current == Current{};
    return empty;
  }

  // Ends the stretch since the last reversal, judges it and begins the next one.
  static constexpr void reverse(const Config& config, State& state, bool forward, typename S::Acceleration a) {
    auto& reference = state.reference[state.forward][state.octave];
    if (state.full && state.silent) reference = state.peak;
    if (state.full && !state.silent && !state.dropped && S::has_grown(state.peak, reference, config.tolerance)) {
      state.dropped = true;
      state.tables = {};
    }
    state.forward = forward;
    state.full = S::far_travelled(state.travel);
    state.octave = static_cast<std::uint8_t>(S::acceleration_octave(a, references - 1));
    state.silent = state.reference[state.forward][state.octave] == Distance{};
    // A silent table is taught only while it is empty: what is missing then is missing without it.
    state.teaches = state.full && (!state.silent || !state.learned[state.forward]);
    state.peak = {};
    state.before = state.current;
    state.travel = {};
  }
};

}  // namespace stiction
