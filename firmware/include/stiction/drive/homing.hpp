// Finds the zero of an axis whose encoder does not know it: homing methods of CiA 402 (IEC 61800-7-201, homing mode,
// 6098h) as a generator of set-points. The set-points are those of the encoder's own coordinates; what comes out is
// where the machine's zero lies in these. Fixed work.
#pragma once

#include <cstdint>

#include "stiction/drive/exchange.hpp"
#include "stiction/drive/state_machine.hpp"
#include "stiction/motion/velocity_ramp.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

// Numbers of 6098h.
enum class HomingMethod : std::int8_t {
  none = 0,             // the encoder is absolute
  limit_negative = 17,  // onto the negative limit switch and off it again: where it opens
  limit_positive = 18,
  home_positive = 19,   // onto a home switch in +x and off it again in -x: where it opens; on it: off it
  home_negative = 21,   // the same in -x
  index_negative = 33,  // the next index mark in -x
  index_positive = 34,
  here = 35,  // where the axis stands
};

template <class S>
struct HomingConfig {
  HomingMethod method = HomingMethod::none;
  typename S::Velocity search_speed{};  // to the switch
  typename S::Velocity creep_speed{};   // off the switch, or to the index
  typename S::Position offset{};        // the machine's position of the mark
  typename S::Position longest_way{};   // from the start to the mark
  std::uint32_t longest_ticks = 0;      // of it all
};

template <class S>
class Homing {
 public:
  using Position = typename S::Position;
  using Velocity = typename S::Velocity;
  using Ramp = VelocityRamp<S>;

  enum class Phase : std::uint8_t {
    idle,
    search,  // towards the switch
    leave,   // off it, or towards the index
    settle,  // the mark is known; to standstill
    done,
    failed,  // no mark within the way or the time
  };

  explicit constexpr Homing(const HomingConfig<S>& config) : config_(config) {}

  constexpr const HomingConfig<S>& config() const { return config_; }
  constexpr Phase phase() const { return state_.phase; }
  // Of the machine's zero in the encoder's coordinates, when done.
  constexpr Position origin() const { return state_.origin; }
  // Bits 13, 12 and 10 of the statusword in this mode: error, attained, at rest. A search that a different fault ends
  // is interrupted, as the standard calls it, and shows no error. `failed`: the fault of homing, which stays until the
  // reset; `at_rest`: the set-point.
  constexpr std::uint16_t status_bits(bool failed, bool at_rest) const {
    std::uint16_t bits = 0;
    if (state_.phase == Phase::done) bits |= statusword::homed_bit;
    if (state_.phase == Phase::failed || failed) bits |= statusword::homing_error_bit;
    const bool ended = state_.phase == Phase::idle || state_.phase == Phase::done || state_.phase == Phase::failed;
    if (ended && at_rest) bits |= statusword::target_bit;
    return bits;
  }
  constexpr bool seeks_negative() const { return seeks(HomingMethod::limit_negative); }
  constexpr bool seeks_positive() const { return seeks(HomingMethod::limit_positive); }

  // Begins where the set-point is. `position`: measured, in the encoder's coordinates.
  constexpr void start(Position position) {
    state_ = {};
    state_.begin = position;
    state_.mark = position;
    state_.phase = config_.method == HomingMethod::none   ? Phase::done
                   : config_.method == HomingMethod::here ? Phase::settle
                   : to_index()                           ? Phase::leave
                                                          : Phase::search;
  }

  constexpr void stop() { state_.phase = Phase::idle; }
  // Stops a search; what has ended is kept.
  constexpr void interrupt() {
    if (state_.phase != Phase::done && state_.phase != Phase::failed) stop();
  }

  // The speed to which the set-point is to go in this tick. `set`: the set-point of the last tick. `measured`:
  // position, m; `inputs`: switches and index of this tick. Returns m/s.
  constexpr Velocity step(const typename Ramp::State& set, Position measured, const DigitalInputs<S>& inputs) {
    const bool at_home = config_.method == HomingMethod::home_negative || config_.method == HomingMethod::home_positive;
    const bool at_switch = at_home ? inputs.home : to_negative() ? inputs.limit_negative : inputs.limit_positive;
    // A switch that bounces while the axis still runs onto it marks nothing.
    const bool leaving = to_negative() ? set.velocity > Velocity{} : set.velocity < Velocity{};
    const bool marked = to_index() ? inputs.index : leaving && !at_switch;
    SaturationCounter none;  // ends in `failed`, as it is beyond every way
    const auto way = narrow<Position>(measured - state_.begin, none);
    const bool too_far = way > config_.longest_way || way < -config_.longest_way;
    const bool moving = state_.phase == Phase::search || state_.phase == Phase::leave;
    state_.ticks += moving ? 1u : 0u;
    if (moving && (too_far || state_.ticks > config_.longest_ticks)) {
      state_.phase = Phase::failed;
    } else if (state_.phase == Phase::search && at_switch) {
      state_.phase = Phase::leave;
    } else if (state_.phase == Phase::leave && marked) {
      state_.mark = to_index() ? inputs.index_position : measured;
      state_.phase = Phase::settle;
    } else if (state_.phase == Phase::settle && set.velocity == Velocity{}) {
      state_.origin = narrow<Position>(state_.mark - config_.offset, none);
      state_.phase = Phase::done;
    }
    return target();
  }

 private:
  struct State {
    Phase phase = Phase::idle;
    Position begin{}, mark{}, origin{};
    std::uint32_t ticks = 0;
  };

  constexpr bool seeks(HomingMethod method) const {
    return config_.method == method && (state_.phase == Phase::search || state_.phase == Phase::leave);
  }

  constexpr bool to_negative() const {
    return config_.method == HomingMethod::limit_negative || config_.method == HomingMethod::index_negative ||
           config_.method == HomingMethod::home_negative;
  }
  constexpr bool to_index() const {
    return config_.method == HomingMethod::index_negative || config_.method == HomingMethod::index_positive;
  }

  constexpr Velocity target() const {
    if (state_.phase == Phase::search) return to_negative() ? opposite(config_.search_speed) : config_.search_speed;
    if (state_.phase != Phase::leave) return {};
    // Off a switch it goes back.
    return to_negative() == to_index() ? opposite(config_.creep_speed) : config_.creep_speed;
  }

  HomingConfig<S> config_;
  State state_;
};

}  // namespace stiction
