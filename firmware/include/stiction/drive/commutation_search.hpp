// Where the magnets of a three-phase motor are against its encoder: the electrical angle at the encoder's zero, as it
// was stored, from Hall signals, or found by a test at the first enabling, and corrected at the encoder's index mark.
//
// The test turns a current vector of angle theta, slowly growing, once in 256 ticks. The force K i cos(phi - theta)
// makes the axis vibrate about where it is; the vibration's phase against theta is phi plus the lag of inverter,
// windings and mechanics. Turned the other way about, it is phi less the same lag, whatever friction, load and brake
// make of it, as both are the same motion mirrored in time; the mean of both is phi or phi plus half a turn. A push
// forwards and one backwards tell which, where they move the axis clearly more than it still moved before them; else
// both are made again after a longer rest. The way is a few hundredths of a pole pair, and what exceeds longest_way
// ends the test. Integer; fixed work but for the tick in which a part of the test ends.
#pragma once

#include <cstdint>

#include "stiction/control/limit.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/number/arc_tangent.hpp"
#include "stiction/number/trigonometry.hpp"

namespace stiction {

enum class CommutationMethod : std::uint8_t {
  encoder_zero,  // the encoder's zero is the motor's; nothing is tested
  stored,        // the offset is known; where `checked`, the test has to agree with it
  test,          // by the test, after each start
  hall,          // from three Hall signals, within 30 degrees at first and exactly from their first edge on
};

template <class S>
struct CommutationConfig {
  CommutationMethod method = CommutationMethod::encoder_zero;
  Turn offset{};         // stored: electrical angle at the encoder's zero; hall: at the rising edge of signal A
  bool checked = false;  // the stored one, at the first enabling
  Turn tolerance{};      // by which two ways of knowing may differ
  bool index_known = false;
  Turn index_angle{};  // at the encoder's index mark
  typename S::PitchInverse inverse_pole_pair_pitch{};
  typename S::Current most_current{};  // amplitude of the test
  typename S::Position response{};     // amplitude of the vibration from which the current grows no more
  typename S::Position longest_way{};  // of the axis in the test
};

// 60-degree sector of Hall signals A, B, C in bits 0 to 2, which are high for half a turn each from 0, 120, 240 degrees
// on; -1: no such code, as of a broken wire.
constexpr int hall_sector(std::uint8_t code) {
  constexpr std::int8_t none = -1;
  constexpr std::array<std::int8_t, 8> sectors{none, 1, 3, 2, 5, 0, 4, none};
  return sectors[code & 7u];
}

template <class S>
class CommutationSearch {
 public:
  using Position = typename S::Position;
  using Current = typename S::Current;

  enum class Phase : std::uint8_t { unknown, waiting, growing, settling, turning, resting, pushing, known, failed };

  // What the axis is to carry in a tick of the test: a current vector of this length and angle.
  struct Order {
    Current current{};
    Turn angle{};
  };

  static constexpr std::int32_t ticks_a_turn = 256;          // of the vector: 62.5 Hz at 62.5 us
  static constexpr std::int32_t settling_ticks = 16 * 256;   // before it is measured
  static constexpr std::int32_t measured_ticks = 16 * 256;   // for which it is measured
  static constexpr std::int32_t longest_rest_ticks = 8000;   // 0.5 s at 62.5 us
  static constexpr std::int32_t push_ticks = 64;             // a push, and as much to brake it
  static constexpr std::int32_t rest_between_pushes = 1024;  // at least; doubled each time that both are made again
  static constexpr std::int32_t most_rounds = 4;

  explicit constexpr CommutationSearch(const CommutationConfig<S>& config)
      : config_(config),
        phase_(trusted(config) ? Phase::known : Phase::unknown),
        offset_(config.method == CommutationMethod::stored ? config.offset : Turn{}) {}

  constexpr bool used() const { return config_.method != CommutationMethod::encoder_zero; }
  constexpr Phase phase() const { return phase_; }
  constexpr bool searching() const {
    return phase_ != Phase::known && phase_ != Phase::failed && phase_ != Phase::unknown;
  }
  constexpr bool known() const { return phase_ == Phase::known; }
  constexpr Turn offset() const { return offset_; }  // in force
  constexpr Turn found() const { return found_; }    // by the last test
  constexpr const Order& order() const { return order_; }
  constexpr std::int64_t way() const { return farthest_; }  // of the last test, raw

  // The power has come on. `measured`: where the axis is; `inputs`: of this tick.
  constexpr void begin(Position measured, const DigitalInputs<S>& inputs) {
    if (phase_ == Phase::known) return;
    fault_ = Fault::none;
    if (config_.method == CommutationMethod::hall) {
      take_hall(measured, inputs);
      return;
    }
    origin_ = last_ = measured;
    farthest_ = 0;
    order_ = {};
    angle_ = {};
    current_raw_ = most_raw() / 32;
    enter(Phase::waiting);
  }

  // The power is gone: what was begun is not finished.
  constexpr void stop() {
    order_ = {};
    if (searching()) phase_ = Phase::unknown;
  }

  // The fault that the search has come to; none. Latched until forget().
  constexpr Fault fault() const { return fault_; }
  constexpr void forget() {
    fault_ = Fault::none;
    if (phase_ == Phase::failed) phase_ = Phase::unknown;
  }

  // The encoder may have lost its place, and the angle with it: the next enabling begins at the beginning. A stored
  // offset that is trusted stays.
  constexpr void lose() {
    if (!trusted(config_)) phase_ = Phase::unknown;
  }

  // Each tick, powered or not: what index and Hall signals say beside the offset in force. `measured`: position;
  // `inputs`: of this tick.
  constexpr void watch(Position measured, const DigitalInputs<S>& inputs) {
    if (phase_ != Phase::known) return;
    if (config_.method == CommutationMethod::hall) watch_hall(measured, inputs);
    if (config_.index_known && inputs.index)
      adopt(minus(config_.index_angle, S::angle(inputs.index_position, config_.inverse_pole_pair_pitch)));
  }

  // One tick of the test. `measured`: position; `standing`: whether the axis is at rest.
  constexpr void step(Position measured, bool standing) {
    const std::int64_t made = measured.raw() - last_.raw();
    last_ = measured;
    const std::int64_t from_origin = measured.raw() - origin_.raw();
    const auto distance = from_origin < 0 ? -from_origin : from_origin;
    farthest_ = distance > farthest_ ? distance : farthest_;
    if (distance > config_.longest_way.raw()) return fail(Fault::commutation_not_found);
    ++tick_;
    switch (phase_) {
      case Phase::waiting:
        // A load that has come onto its brake yields for a while.
        if (rested(standing)) enter(Phase::growing);
        return;
      case Phase::growing:
        return grow(made);
      case Phase::settling:
        turn();
        if (tick_ == settling_ticks) enter(Phase::turning);
        return;
      case Phase::turning:
        return measure(made, from_origin);
      case Phase::resting:
        return rest(standing);
      case Phase::pushing:
        return push(measured);
      default:
        return;
    }
  }

 private:
  // Whether the angle is known from the start, and stays so.
  static constexpr bool trusted(const CommutationConfig<S>& config) {
    return config.method == CommutationMethod::encoder_zero ||
           (config.method == CommutationMethod::stored && !config.checked);
  }
  static constexpr Turn plus(Turn a, Turn b) { return Turn{a.raw + b.raw}; }
  static constexpr Turn minus(Turn a, Turn b) { return Turn{a.raw - b.raw}; }
  // |a - b|, at most half a turn.
  static constexpr std::uint32_t apart(Turn a, Turn b) {
    const std::uint32_t d = a.raw - b.raw;
    return d > (std::uint32_t{1} << 31) ? 0u - d : d;
  }
  constexpr std::int64_t most_raw() const { return config_.most_current.raw(); }
  constexpr void enter(Phase phase) {
    phase_ = phase;
    tick_ = 0;
    cosine_ = sine_ = sum_ = 0;
  }
  constexpr void fail(Fault fault) {
    fault_ = fault;
    order_ = {};
    phase_ = Phase::failed;
  }

  constexpr void turn() {
    constexpr std::uint32_t a_tick = std::uint32_t{1} << 24;
    angle_.raw += backwards_ ? 0u - a_tick : a_tick;
    order_ = {Current::from_bounded_raw(current_raw_), angle_};
  }
  // Adds what the axis made in a tick, against the vector's angle.
  constexpr void add(std::int64_t made) {
    constexpr std::int64_t most = std::int64_t{1} << 26;
    const std::int64_t bounded = made > most ? most : made < -most ? -most : made;
    cosine_ += bounded * (cosine(angle_).raw() >> 15);
    sine_ += bounded * (stiction::sine(angle_).raw() >> 15);
  }
  // Of one turn of a vibration of the amplitude X: pi X 2^15.
  constexpr std::int64_t strength() const {
    const std::int64_t c = cosine_ < 0 ? -cosine_ : cosine_, s = sine_ < 0 ? -sine_ : sine_;
    return c > s ? c + s / 2 : s + c / 2;
  }

  constexpr std::int64_t wanted() const { return config_.response.raw() * 102944; }

  // A quarter more current each turn, until the axis vibrates enough or the current is all that is allowed.
  constexpr void grow(std::int64_t made) {
    add(made);
    if (tick_ == ticks_a_turn) {
      const bool enough = strength() >= wanted();
      if (enough || current_raw_ >= most_raw()) {
        if (!enough && strength() < wanted() / 4) return fail(Fault::commutation_not_found);
        backwards_ = false;
        enter(Phase::settling);
      } else {
        const std::int64_t more = current_raw_ + current_raw_ / 4;
        current_raw_ = more > most_raw() ? most_raw() : more;
        enter(Phase::growing);
      }
    }
    turn();
  }

  constexpr void measure(std::int64_t made, std::int64_t from_origin) {
    add(made);
    sum_ += from_origin;
    if (tick_ < measured_ticks) return turn();
    const std::int64_t size = strength();
    const Turn seen = angle_of(cosine_ >> 2, sine_ >> 2);
    const std::int64_t middle = sum_ / measured_ticks;
    // What made a turn strong was no vibration, and has gone.
    constexpr std::int64_t turns = measured_ticks / ticks_a_turn;
    if (size < turns * wanted() / 4) {
      if (current_raw_ >= most_raw() || backwards_) return fail(Fault::commutation_not_found);
      current_raw_ = current_raw_ * 5 / 4 > most_raw() ? most_raw() : current_raw_ * 5 / 4;
      enter(Phase::growing);
      return turn();
    }
    if (!backwards_) {
      forward_ = seen;
      forward_size_ = size;
      middle_ = middle;
      backwards_ = true;
      // The vibration goes on as it is: the force of the mirrored vector continues that of this one.
      angle_ = Turn{2 * seen.raw + (std::uint32_t{1} << 31) - angle_.raw};
      enter(Phase::settling);
      return turn();
    }
    // Of a vibration that did not last the parts are not the same motion.
    if (size < forward_size_ / 4 || forward_size_ < size / 4) return fail(Fault::commutation_not_found);
    // One of two opposite angles, of which the pushes take one.
    const std::int32_t half = static_cast<std::int32_t>(seen.raw - forward_.raw) / 2;
    const Turn mean{forward_.raw + static_cast<std::uint32_t>(half)};
    const auto at = Position::from_raw(origin_.raw() + (middle_ + middle) / 2);
    found_ = minus(mean, S::angle(at, config_.inverse_pole_pair_pitch));
    round_ = 0;
    prepare_pushes();
  }

  constexpr void prepare_pushes() {
    order_ = {};
    enter(Phase::resting);
    push_ = 0;
    pushed_ = moved_ = {};
    still_moves_ = 0;
  }

  constexpr bool rested(bool standing) const {
    return tick_ >= rest_between_pushes && (standing || tick_ >= longest_rest_ticks);
  }
  // How far the axis goes by itself in as many ticks as a push has is known of the last ones, fading: a vibration may
  // show little of itself in one of them.
  constexpr void rest(bool standing) {
    order_ = {};
    if (tick_ == 1) rest_from_ = last_;
    sum_ += last_.raw() - rest_from_.raw();
    if (tick_ % push_ticks != 0) return;
    const std::int64_t size = sum_ < 0 ? -sum_ : sum_;
    still_moves_ -= still_moves_ / 8;
    still_moves_ = size > still_moves_ ? size : still_moves_;
    sum_ = 0;
    rest_from_ = last_;
    if (!rested(standing) || tick_ < rest_between_pushes << round_) return;
    if (push_ == 2) return decide();
    moved_[push_] = still_moves_;
    enter(Phase::pushing);
    pushed_from_ = last_;
  }

  // Forwards, as long twice backwards, forwards: the axis is at rest again where it was. The way of the first part
  // tells.
  constexpr void push(Position measured) {
    const bool first = tick_ <= push_ticks, braking = !first && tick_ <= 3 * push_ticks;
    if (first) pushed_[push_] += measured.raw() - pushed_from_.raw();
    Turn angle = plus(found_, S::angle(measured, config_.inverse_pole_pair_pitch));
    if (braking != (push_ == 1)) angle.raw += std::uint32_t{1} << 31;
    order_ = {Current::from_bounded_raw(current_raw_), angle};
    if (tick_ < 4 * push_ticks) return;
    order_ = {};
    ++push_;
    enter(Phase::resting);
    still_moves_ = 0;
  }

  constexpr void decide() {
    const std::int64_t difference = pushed_[0] - pushed_[1];
    // Of a push that moved the axis at all: as far as half of the vibration's amplitude for an eighth of its ticks.
    const std::int64_t least = config_.response.raw() / 16 * push_ticks / 8;
    // A vibration goes on by no more than twice what it showed; twice that is in doubt.
    const std::int64_t doubtful = 4 * (moved_[0] + moved_[1]);
    const std::int64_t size = difference < 0 ? -difference : difference;
    if (size < least || size < doubtful) {
      if (++round_ == most_rounds) return fail(Fault::commutation_not_found);
      return prepare_pushes();
    }
    if (difference < 0) found_.raw += std::uint32_t{1} << 31;
    order_ = {};
    if (config_.method == CommutationMethod::stored) {
      if (apart(found_, config_.offset) > config_.tolerance.raw) return fail(Fault::commutation_offset);
      offset_ = config_.offset;
    } else {
      offset_ = found_;
    }
    phase_ = Phase::known;
  }

  // An offset that is exact: taken where it agrees with the one in force.
  constexpr void adopt(Turn exact) {
    if (apart(exact, offset_) > config_.tolerance.raw) return fail(Fault::commutation_offset);
    offset_ = exact;
  }

  constexpr void take_hall(Position measured, const DigitalInputs<S>& inputs) {
    const int sector = hall_sector(inputs.hall);
    if (sector < 0) return fail(Fault::commutation_not_found);
    sector_ = static_cast<std::int8_t>(sector);
    at_edge_ = false;
    const Turn middle{static_cast<std::uint32_t>(2 * sector + 1) * twelfth};
    offset_ = minus(plus(middle, config_.offset), S::angle(measured, config_.inverse_pole_pair_pitch));
    last_ = measured;
    phase_ = Phase::known;
  }

  constexpr void watch_hall(Position measured, const DigitalInputs<S>& inputs) {
    const int sector = hall_sector(inputs.hall);
    if (sector < 0) return fail(Fault::commutation_not_found);
    const int gone = (sector - sector_ + 6) % 6;
    const auto between = Position::from_raw(last_.raw() + (measured.raw() - last_.raw()) / 2);
    last_ = measured;
    if (gone == 0) return;
    sector_ = static_cast<std::int8_t>(sector);
    if (gone != 1 && gone != 5) return fail(Fault::commutation_offset);
    // The edge between both sectors; upwards it is where the new one begins.
    const int edge = gone == 1 ? sector : sector + 1;
    const Turn angle = plus(Turn{static_cast<std::uint32_t>(2 * edge) * twelfth}, config_.offset);
    const Turn exact = minus(angle, S::angle(between, config_.inverse_pole_pair_pitch));
    const std::uint32_t most = at_edge_ ? config_.tolerance.raw : twelfth + config_.tolerance.raw;
    if (apart(exact, offset_) > most) return fail(Fault::commutation_offset);
    offset_ = exact;
    at_edge_ = true;
  }

  static constexpr std::uint32_t twelfth = 357913941;  // of a turn

  CommutationConfig<S> config_;
  Phase phase_ = Phase::unknown;
  Fault fault_ = Fault::none;
  Turn offset_{};
  Turn found_{}, angle_{}, forward_{};
  Order order_{};
  bool backwards_ = false, at_edge_ = false;
  std::int8_t sector_ = 0;
  std::uint8_t push_ = 0;
  std::int32_t round_ = 0;  // of pushes
  std::int32_t tick_ = 0;
  std::int64_t current_raw_ = 0;
  Position origin_{}, last_{}, pushed_from_{}, rest_from_{};
  std::int64_t farthest_ = 0, cosine_ = 0, sine_ = 0, sum_ = 0, middle_ = 0, forward_size_ = 0;
  std::int64_t still_moves_ = 0;
  std::array<std::int64_t, 2> pushed_{}, moved_{};  // sums over the ticks of a push, and of a rest before it
};

}  // namespace stiction
