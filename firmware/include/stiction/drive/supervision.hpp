// What watches an axis from outside of its cascade, before each tick: an encoder that stands still or jumps, current
// sensors that do not sum to zero, a force of the wrong sign, limit switches. It sees this tick's feedback and the
// set-points up to the last tick, so that what it finds keeps the power stage off in the same tick. Rows of
// fault_table with Detector::supervision; fixed work.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/delay_line.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct SupervisionConfig {
  std::int64_t period_ns = 0;  // of the fast tick
  typename S::Distance frozen_distance{};
  typename S::Distance encoder_jump{};
  bool phases_sum = false;        // three phases whose currents sum to zero
  bool current_measured = false;  // there are current sensors at all
  typename S::Current current_sum{};
  typename S::Current runaway_current{};
  // Rise of the speed in a row of runaway ticks that is no noise: half of what runaway_current makes of the mass.
  typename S::Velocity runaway_rise{};
  typename S::Velocity least_speed{};                     // from which the carriage is moving
  bool negative_switch = false, positive_switch = false;  // whether they are wired
  // A switch that is reached on the inner side of `..._from`, or not on the outer side of `..._by`, is stuck.
  typename S::Position negative_from{}, negative_by{};
  typename S::Position positive_from{}, positive_by{};
};

// Numbers of the fault table.
inline constexpr std::uint8_t supervised_row_ticks = 16;  // of an offset and of a runaway
inline constexpr std::uint8_t opposed_ticks = 31;  // two changes of the velocity over 15 ticks each, and the first

template <class S>
class Supervision {
 public:
  using Position = typename S::Position;
  using Velocity = typename S::Velocity;
  using Current = typename S::Current;

  // Of a tick, before the axis has it.
  struct Seen {
    Feedback<S> feedback{};
    DigitalInputs<S> inputs{};
    std::int64_t now_ns = 0;
    bool powered = false;     // the power stage was on since the last tick
    Current current{};        // that makes the force
    Position set_position{};  // of the last tick, as is the speed
    Velocity set_velocity{};
    bool referenced = false;      // the zero of the position is known,
    Position position{};          // so that this is one of the machine
    bool seeks_negative = false;  // homing moves to a switch on purpose
    bool seeks_positive = false;
  };

  explicit constexpr Supervision(const SupervisionConfig<S>& config) : config_(config) {}

  constexpr const SupervisionConfig<S>& config() const { return config_; }
  constexpr bool fresh() const { return state_.fresh; }            // whether the last tick brought a new valid position
  constexpr Velocity velocity() const { return state_.velocity; }  // between the last two positions
  // Whether, in opposed_ticks in a row, a force above runaway_current met an acceleration the other way of more than a
  // quarter of what it would make of the mass, which did not abate from one half of them to the other. What takes the
  // speed as friction does takes less of it the slower the axis is; a motor of the wrong sign takes more the harder it
  // is driven. An obstacle that is hard or a spring looks like it, so that it is no fault by itself; but no control
  // brings down an error while it lasts.
  constexpr bool resisted() const { return state_.resisted; }

  // Forgets what was: after a reset, when a motion may have gone unseen.
  constexpr void restart() { state_ = {}; }

  constexpr Fault step(const Seen& seen) {
    take_position(seen);
    const bool jump = jumped(seen);
    const bool frozen = stands_still(seen);
    remember(seen);
    const bool offset = has_offset(seen);
    const bool runaway = runs_away(seen);
    const bool stuck = switch_stuck(seen);
    const bool reached = switch_reached(seen);
    Fault fault = Fault::none;
    fault = reached ? Fault::limit_switch : fault;
    fault = stuck ? Fault::limit_switch_stuck : fault;
    fault = runaway ? Fault::runaway : fault;
    fault = offset ? Fault::current_offset : fault;
    fault = frozen ? Fault::encoder_frozen : fault;
    return jump ? Fault::encoder_jump : fault;
  }

 private:
  // Ticks after which the currents of a power stage that went off have ended: 2 ms.
  static constexpr std::uint8_t currents_end = 32;

  struct State {
    bool fresh = false;
    std::uint8_t known = 0;  // positions in a row that are close in time: from two on the next one can be foretold
    Position x1{};           // the last one
    std::int64_t t1_ns = 0;
    Position x{};  // this one
    std::int64_t gap_ns = 0;
    Velocity velocity{};  // between the last two

    bool anchored = false;
    Position unchanged{};  // the position that the encoder shows ever since
    Position set{};        // the set-point was here

    std::uint8_t off_ticks = 0;
    std::uint8_t offset_row = 0;
    std::uint8_t runaway_row = 0, opposed_row = 0;
    bool resisted = false;
    DelayLine<Velocity, 32> velocities{};
  };

  static constexpr Velocity magnitude(Velocity v) { return v < Velocity{} ? opposite(v) : v; }

  // A sample that came before is as good as none, and a stamp from the future is no stamp: as in the axis.
  constexpr void take_position(const Seen& seen) {
    const auto& f = seen.feedback;
    state_.fresh = f.position_valid && (state_.known == 0 || f.position_time_ns > state_.t1_ns) &&
                   f.position_time_ns <= seen.now_ns + config_.period_ns;
    state_.x = state_.fresh ? f.position : state_.x1;
    state_.gap_ns = state_.fresh && state_.known != 0 ? f.position_time_ns - state_.t1_ns : config_.period_ns;
    // Two ticks without a position may lie between; after a longer gap the motion in it is not known.
    constexpr int periods_of_a_gap = 4;
    if (state_.fresh && state_.gap_ns >= periods_of_a_gap * config_.period_ns) state_.known = 0;
  }

  // The way since the last position against that at the speed before. A constant acceleration a leaves a T^2: 78 nm at
  // 20 m/s^2 and 62.5 us. The very same position is left to the watch over a frozen encoder.
  constexpr bool jumped(const Seen&) {
    const auto led = narrow<typename S::Step>(state_.velocity * S::seconds(state_.gap_ns), meant_);
    const auto beside = narrow<typename S::Distance>(state_.x - state_.x1 - led, meant_);
    return state_.fresh && state_.known >= 2 && state_.x != state_.x1 && exceeds(beside, config_.encoder_jump);
  }

  constexpr bool stands_still(const Seen& seen) {
    const bool same = state_.anchored && state_.x == state_.unchanged && seen.powered;
    if (!same && (state_.fresh || !seen.powered)) {
      state_.anchored = state_.fresh && seen.powered;
      state_.unchanged = state_.x;
      state_.set = seen.set_position;
    }
    const auto way = narrow<typename S::Distance>(seen.set_position - state_.set, meant_);
    return same && state_.fresh && exceeds(way, config_.frozen_distance);
  }

  constexpr void remember(const Seen& seen) {
    const auto way = narrow<typename S::Step>(state_.x - state_.x1, meant_);
    const auto velocity = narrow<Velocity>(way * S::rate(state_.gap_ns), meant_);
    if (!state_.fresh) return;
    state_.velocity = state_.known == 0 ? Velocity{} : velocity;
    state_.known = state_.known < 2 ? static_cast<std::uint8_t>(state_.known + 1) : state_.known;
    state_.x1 = state_.x;
    state_.t1_ns = seen.feedback.position_time_ns;
  }

  // Under power the sum tells; without it each phase alone does.
  constexpr bool has_offset(const Seen& seen) {
    const auto& i = seen.feedback.current;
    const bool sum = config_.phases_sum && exceeds(i[0] + i[1] + i[2], config_.current_sum);
    const bool any =
        exceeds(i[0], config_.current_sum) || exceeds(i[1], config_.current_sum) || exceeds(i[2], config_.current_sum);
    const std::uint8_t off = state_.off_ticks;
    state_.off_ticks = seen.powered ? 0 : off < currents_end ? static_cast<std::uint8_t>(off + 1) : off;
    const bool violated = config_.current_measured && (sum || (any && off == currents_end));
    state_.offset_row = next_of_row(state_.offset_row, violated);
    return state_.offset_row == supervised_row_ticks;
  }

  // A force against the motion, and yet the speed rises by more than this force can be wrong about. An axis that
  // brakes has the force but not the rise.
  constexpr bool runs_away(const Seen& seen) {
    const Velocity v = state_.velocity;
    const bool against = v < Velocity{} ? seen.current > Current{} : seen.current < Current{};
    const bool strong = seen.powered && exceeds(seen.current, config_.runaway_current);
    state_.velocities.push(v);
    constexpr std::uint32_t row = supervised_row_ticks - 1;
    const Velocity before = state_.velocities.at(row);
    watch_force(strong, seen.current, saturated_difference(v, before, meant_),
                saturated_difference(before, state_.velocities.at(2 * row), meant_));
    state_.runaway_row = next_of_row(state_.runaway_row, strong && against);
    const auto rise = saturated_difference(magnitude(v), magnitude(before), meant_);
    return state_.runaway_row == supervised_row_ticks && rise > config_.runaway_rise;
  }

  // `strong`: whether `current` makes a force to speak of; `change`: of the velocity in the newest half of
  // opposed_ticks, `earlier`: in the other one.
  constexpr void watch_force(bool strong, Current current, Velocity change, Velocity earlier) {
    const bool positive = current > Current{};
    const Velocity against = positive ? opposite(change) : change;
    const Velocity earlier_against = positive ? opposite(earlier) : earlier;
    const bool opposed = strong && against > least_change(current);
    const std::uint8_t row = state_.opposed_row;
    state_.opposed_row = !opposed ? 0 : row < opposed_ticks ? static_cast<std::uint8_t>(row + 1) : row;
    // By more than an eighth: friction of 100 kN s/m on 520 kg abates by 17 %, its time constant is 5.2 ms. A change as
    // large as this is above the noise of an encoder many times.
    const Velocity twice = doubled(saturated_difference(earlier_against, against, meant_));
    const bool abates = doubled(doubled(twice)) > earlier_against;
    state_.resisted = state_.opposed_row == opposed_ticks && !abates;
  }
  // Between a half and a quarter of what the current makes of the mass, up to eight times runaway_current: the rise
  // belongs to a half of that one.
  constexpr Velocity least_change(Current current) {
    auto change = config_.runaway_rise;
    auto most = doubled(config_.runaway_current);
    for (int i = 0; i < 2; ++i) {
      if (exceeds(current, most)) change = doubled(change);
      most = doubled(most);
    }
    return change;
  }
  template <class Value>
  constexpr Value doubled(Value value) {
    return saturated_sum(value, value, meant_);
  }

  constexpr bool switch_reached(const Seen& seen) const {
    const bool down = seen.set_velocity < Velocity{} || state_.velocity < negative(config_.least_speed);
    const bool up = seen.set_velocity > Velocity{} || state_.velocity > config_.least_speed;
    return seen.powered && ((seen.inputs.limit_negative && down && !seen.seeks_negative) ||
                            (seen.inputs.limit_positive && up && !seen.seeks_positive));
  }

  constexpr bool switch_stuck(const Seen& seen) const {
    const auto& in = seen.inputs;
    const bool closed = (in.limit_negative && seen.position > config_.negative_from) ||
                        (in.limit_positive && seen.position < config_.positive_from);
    const bool open = (config_.negative_switch && !in.limit_negative && seen.position < config_.negative_by) ||
                      (config_.positive_switch && !in.limit_positive && seen.position > config_.positive_by);
    return (in.limit_negative && in.limit_positive) || (seen.referenced && (closed || open));
  }

  static constexpr std::uint8_t next_of_row(std::uint8_t row, bool violated) {
    if (!violated) return 0;
    return row < supervised_row_ticks ? static_cast<std::uint8_t>(row + 1) : row;
  }

  SupervisionConfig<S> config_;
  State state_;
  SaturationCounter meant_;  // differences that leave their format are far beyond every threshold
};

}  // namespace stiction
