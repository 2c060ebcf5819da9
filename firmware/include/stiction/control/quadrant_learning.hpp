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
struct QuadrantLearning {
  using Current = typename S::Current;
  using Distance = typename S::Distance;
  using Weight = typename S::FilterCoefficient;

  static constexpr std::size_t nodes = S::travel_nodes;
  static constexpr std::uint32_t credit_buffer = 128;  // ticks
  using Table = std::array<Current, nodes>;
  using Tables = std::array<Table, 2>;  // by direction: backward, forward

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
    typename S::Step travel{};      // since the last reversal; stays at 2 mm
    Current current{};              // played now
    Current before{};               // at the last reversal
    bool forward = false;           // direction of the last motion
    bool full = false;              // the way before the last reversal was a long one
    bool reversed = false;          // in this tick; what that means is judged in the place of its learning
    bool was_full = false;          // the stretch that it ended began after a long way
    bool silent = false;            // the table is not played since the last reversal, to take the reference
    bool teaches = false;           // since the last reversal
    bool plays = false;             // likewise: it is a long way, not silent, not dropped
    std::array<bool, 2> learned{};  // something, by direction
    bool dropped = false;
    std::uint8_t octave = 0;                          // of the acceleration at the last reversal
    typename S::Acceleration acceleration{};          // of the newest set-point
    DelayLine<std::uint8_t, credit_buffer> passed{};  // where the set-point was: direction and node, 0: not to learn
    std::uint8_t credited = 0;                        // what of it the tick before credited
    Distance error{};                                 // of the tick before
    Current missing{};                                // lowpassed
    Distance peak{};                                  // largest error since the last reversal
    std::array<std::array<Distance, references>, 2> reference{};  // by direction; 0: not taken yet
  };

  // Whether the configured table is of this machine; of another one none is taken.
  static constexpr bool takes(const Config& config) { return config.tables_machine == config.machine; }

  static constexpr State start(const Config& config) {
    State state;
    if (!takes(config)) return state;
    state.tables = config.tables;
    state.learned = {!is_empty(config.tables[0]), !is_empty(config.tables[1])};
    return state;
  }

  // The current for the newest set-point, `dx` further than the one before. `v`, `a`: its speed and acceleration. The
  // Config is not used here; `state`: tables and the segment since the last reversal, changed by the call;
  // `saturations`: counts results that exceed the format.
  [[gnu::always_inline]] static constexpr Current play(const Config&, State& state, typename S::Step dx,
                                                       typename S::Velocity v, typename S::Acceleration a,
                                                       SaturationCounter& saturations) {
    const typename S::Velocity rest{};
    const bool forward = v > rest || (state.forward && !(v < rest));
    state.reversed = forward != state.forward;
    state.acceleration = a;
    if (state.reversed) turn(state, forward);
    state.travel = S::add_travel(state.travel, dx);

    const auto [node, fraction] = S::travel_place(state.travel);
    const auto& table = state.tables[forward];
    const std::size_t upper = node + 1 < nodes ? node + 1 : node;
    // In the tick of a reversal it does not matter yet whether the table plays: all is still as before.
    const auto learned = state.plays ? between<S>(table[node], table[upper], fraction) : Current{};
    const auto jump = saturated_difference(state.before, state.plays ? table[0] : Current{}, saturations);
    const auto blended = saturated_sum(learned, between<S>(Current{}, jump, S::blend(state.travel)), saturations);
    state.current = state.full ? blended : state.before;
    state.passed.push(static_cast<std::uint8_t>(state.teaches ? node + 1 + (forward ? forward_mark : 0u) : 0u));
    return state.current;
  }

  // Takes the following error of the tick that the axis has just controlled. A tick does one of three things, so that
  // it never costs all of them: after a reversal it judges the stretch that ended, where the set-point came to another
  // node it teaches the table, else it filters the error; what changes meanwhile is in the next difference. `config`:
  // gains, limits and dead zone; `state`: changed by the call; `e`: following error, m; `saturations`: counts results
  // that exceed the format.
  [[gnu::always_inline]] static constexpr void learn(const Config& config, State& state, Distance e,
                                                     SaturationCounter& saturations) {
    const Distance magnitude = e < Distance{} ? opposite(e) : e;
    state.peak = magnitude > state.peak ? magnitude : state.peak;
    const std::uint8_t now = state.passed.at(config.credit_ticks);
    if (state.reversed) {
      judge(config, state);
    } else if (now != state.credited) {
      teach(config, state, now, saturations);
    } else {
      filter(config, state, e, saturations);
    }
  }

 private:
  static constexpr unsigned forward_mark = 64;
  static_assert(nodes < forward_mark);

  static constexpr bool is_empty(const Table& table) {
    bool empty = true;
    for (const auto& current : table) empty = empty && current == Current{};
    return empty;
  }

  static constexpr void turn(State& state, bool forward) {
    state.forward = forward;
    state.was_full = state.full;
    state.full = S::far_travelled(state.travel);
    state.teaches = false;
    state.before = state.current;
    state.travel = {};
  }

  // Judges the stretch that ended and decides on the next one.
  static constexpr void judge(const Config& config, State& state) {
    auto& reference = state.reference[!state.forward][state.octave];
    if (state.was_full && state.silent) reference = state.peak;
    if (state.was_full && !state.silent && S::has_grown(state.peak, reference, config.tolerance)) state.dropped = true;
    state.octave = static_cast<std::uint8_t>(S::acceleration_octave(state.acceleration, references - 1));
    state.silent = state.reference[state.forward][state.octave] == Distance{};
    // A silent table is taught only while it is empty: what is missing then is missing without it.
    state.teaches = state.full && (!state.silent || !state.learned[state.forward]);
    state.plays = state.full && !state.silent && !state.dropped;
    state.peak = {};
  }

  [[gnu::always_inline]] static constexpr void filter(const Config& config, State& state, Distance e,
                                                      SaturationCounter& saturations) {
    const auto change = clamped(saturated_difference(e, state.error, saturations), config.error_limit);
    state.error = e;
    const auto in_zone = clamped(e, config.dead_zone);
    const auto beyond = clamped(saturated_difference(e, in_zone, saturations), config.error_limit);
    const auto raw = narrow<Current>(config.rate_gain * change + config.error_gain * beyond, saturations);
    state.missing = narrow<Current>(config.filter * raw + config.filter_rest * state.missing, saturations);
  }

  [[gnu::always_inline]] static constexpr void teach(const Config& config, State& state, std::uint8_t now,
                                                     SaturationCounter& saturations) {
    state.credited = now;
    if (now == 0 || !config.adapt || state.dropped) return;
    const bool forward = (now & forward_mark) != 0;
    auto& table = state.tables[forward];
    const std::size_t node = (now & (forward_mark - 1u)) - 1;
    const std::size_t lower = node > 0 ? node - 1 : node, upper = node + 1 < nodes ? node + 1 : node;
    const auto neighbours = saturated_sum(table[lower], table[upper], saturations);
    const auto taught = narrow<Current>(
        config.keep * table[node] + config.gain * state.missing + config.smoothing * neighbours, saturations);
    table[node] = clamped(taught, config.limit);
    state.learned[forward] = true;
  }
};

}  // namespace stiction
