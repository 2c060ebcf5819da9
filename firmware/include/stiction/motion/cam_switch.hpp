// Cam switches (PLCopen: MC_DigitalCamSwitch) of a master or an axis: up to 32 tracks that are on between two places of
// its cycle, or for a time from the first on. Places are in 2^-32 cycles, times in 2^-16 ticks.
//
// Compensation in time: a track whose valve needs 8 ms is switched 8 ms before the place is reached. The place that
// counts is the one at which the master will be then, from its speed and its acceleration; negative is earlier, in
// either direction.
//
// Hysteresis acts where the master goes back over the place that switched last, and only there: a track that a master
// at rest on its edge would make flutter stays as it is, and no edge of a master that goes on is late for it.
//
// Each edge has the time by which it came before the tick, so that outputs with timers switch between two ticks.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "stiction/motion/master_position.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

class CamSwitch {
 public:
  static constexpr std::size_t most_tracks = 32;
  static constexpr int time_bits = 16;  // 2^-16 ticks

  enum class Direction : std::uint8_t { both, positive, negative };
  enum class Kind : std::uint8_t { position, duration };

  struct Track {
    std::uint32_t first = 0, last = 0;  // on from `first` to before `last`; around the seam where first is larger
    std::int32_t duration = 0;          // of the kind duration, above 0
    std::int32_t on_compensation = 0, off_compensation = 0;
    std::uint32_t hysteresis = 0;  // held to a quarter of the window, and of what is left of the cycle
    Direction direction = Direction::both;
    Kind kind = Kind::position;

    friend constexpr bool operator==(const Track&, const Track&) = default;
  };

  struct State {
    std::uint32_t on = 0;        // by the master
    std::uint32_t forward = 0;   // whether the last edge was one of a positive speed, or a master is behind the place
    std::uint32_t switched = 0;  // tracks that had an edge, or of which the place was seen
    std::array<std::int32_t, most_tracks> left{};        // of a duration
    std::array<std::uint16_t, most_tracks> edge_time{};  // before the tick, of an edge in it: 2^-16 ticks
  };

  struct Forces {
    std::uint32_t enabled = UINT32_MAX;  // a track that is not is off
    std::uint32_t forced_on = 0, forced_off = 0;
  };

  struct Output {
    std::uint32_t on = 0;       // with forces
    std::uint32_t changed = 0;  // tracks with an edge in this tick, whose time is in the state
  };

  // A tick: `tracks`, the first `count` of them, at the `master`; `state` is changed. `forces`: what is disabled or
  // forced. Each track has fixed work, but for a division where it has an edge.
  template <std::size_t Count>
  static constexpr Output step(const std::array<Track, Count>& tracks, State& state, const MasterPoint& master,
                               const Forces& forces) {
    static_assert(Count <= most_tracks, "CamSwitch: up to 32 tracks");
    const Moving now(master);
    const std::uint32_t before = state.on;
    for (std::size_t k = 0; k < Count; ++k)
      if (tracks[k].kind == Kind::position)
        step_position(tracks[k], state, k, now);
      else
        step_duration(tracks[k], state, k, now);
    const std::uint32_t on = ((state.on & forces.enabled) | forces.forced_on) & ~forces.forced_off;
    return {on, state.on ^ before};
  }

 private:
  // The master in the units of the switches.
  struct Moving {
    explicit constexpr Moving(const MasterPoint& master)
        : place(master.position.coarse()),
          step(master.velocity >> 20),
          velocity(master.velocity),
          acceleration(master.acceleration) {}

    // From where it was `time` ago, 2^-16 ticks, in 2^-32 cycles; of a time that is negative, to where it will be.
    constexpr std::int64_t way(std::int32_t time) const {
      const std::int64_t change = product_by_word<time_bits + 20>(acceleration, time);
      return product_by_word<time_bits + 20>(velocity - (change << (20 - MotionPoint::tick_bits - 1)), time);
    }

    std::uint32_t place;
    std::int64_t step;  // of a tick
    std::int64_t velocity, acceleration;
  };

  static constexpr bool bit(std::uint32_t word, std::size_t k) { return (word >> k & 1u) != 0; }
  static constexpr void set(std::uint32_t& word, std::size_t k, bool value) {
    word = value ? word | std::uint32_t{1} << k : word & ~(std::uint32_t{1} << k);
  }

  static constexpr bool may_switch(Direction direction, std::int64_t step) {
    return direction == Direction::both || (direction == Direction::positive ? step > 0 : step < 0);
  }

  static constexpr void step_position(const Track& track, State& state, std::size_t k, const Moving& now) {
    const bool was_on = bit(state.on, k), forward = bit(state.forward, k), back = now.step < 0;
    const std::uint32_t width = track.last - track.first, gap = std::uint32_t{0} - width;
    const std::uint32_t least = (width < gap ? width : gap) / 4;
    // Of the edge that switched last, for a master that goes back over it.
    const std::int64_t narrow = bit(state.switched, k) ? (track.hysteresis < least ? track.hysteresis : least) : 0;
    const std::int64_t wider = was_on ? narrow : -narrow;
    const bool edge_is_first = was_on == forward;
    // The edge that a master comes to first is the one that switches on, in either direction.
    const std::int64_t on_way = now.way(track.on_compensation), off_way = now.way(track.off_compensation);
    const std::int64_t first = (back ? off_way : on_way) - (edge_is_first ? wider : 0);
    const std::int64_t last = (back ? on_way : off_way) + (edge_is_first ? 0 : wider);
    const std::uint32_t from = track.first + static_cast<std::uint32_t>(first);
    const std::uint32_t to = track.last + static_cast<std::uint32_t>(last);
    // A window without width is a whole cycle.
    const std::int64_t length = (width == 0 ? whole : std::int64_t{width}) + last - first;
    bool on = width == 0 || length >= whole || std::int64_t{now.place - from} < length;
    if (on && !was_on && !may_switch(track.direction, now.step)) on = false;
    if (on == was_on) return;
    set(state.on, k, on);
    set(state.forward, k, !back);
    set(state.switched, k, true);
    state.edge_time[k] = time_since(now.place - (on != back ? from : to), now.step);
  }

  // On for the duration from when the master passes the first place.
  static constexpr void step_duration(const Track& track, State& state, std::size_t k, const Moving& now) {
    const std::uint32_t from = track.first + static_cast<std::uint32_t>(now.way(track.on_compensation));
    const std::uint32_t beyond = now.place - from;
    const bool is_behind = beyond < half, near = beyond + quarter < half;
    const bool passed = bit(state.switched, k) && near && is_behind != bit(state.forward, k);
    set(state.forward, k, is_behind);
    set(state.switched, k, true);
    if (bit(state.on, k)) {
      state.left[k] -= std::int32_t{1} << time_bits;
      if (state.left[k] > 0) return;
      set(state.on, k, false);
      state.edge_time[k] = static_cast<std::uint16_t>(-state.left[k]);
      return;
    }
    if (!passed || !may_switch(track.direction, is_behind ? 1 : -1)) return;
    set(state.on, k, true);
    state.edge_time[k] = time_since(beyond, now.step);
    state.left[k] = track.duration - state.edge_time[k];
  }

  // How long ago, at `step` a tick, a place was passed that the master is `beyond`, in either direction; up to a tick.
  // 0 of one that no motion passed just now.
  static constexpr std::uint16_t time_since(std::uint32_t beyond, std::int64_t step) {
    const std::uint64_t of_tick = magnitude(step), way = step < 0 ? std::uint32_t{0} - beyond : beyond;
    if (way >= of_tick) return way < 2 * of_tick ? UINT16_MAX : 0;
    // In 16 bits of a tick's way, for a division of one word.
    const int length = 64 - std::countl_zero(of_tick), shift = length > 16 ? length - 16 : 0;
    const auto part = static_cast<std::uint32_t>(way >> shift), all = static_cast<std::uint32_t>(of_tick >> shift);
    return static_cast<std::uint16_t>((part << time_bits) / (all + 1));
  }

  static constexpr std::int64_t whole = std::int64_t{1} << 32;
  static constexpr std::uint32_t half = 0x80000000u, quarter = 0x40000000u;
};

}  // namespace stiction
