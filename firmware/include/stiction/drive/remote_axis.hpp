// An axis that others command over a bus, from what they ask for to its set-point in each tick: cyclic synchronous
// position (csp) from targets that come each cycle, profile position (pp) from one target at a time, both as CiA 402
// (IEC 61800-7-201) has them. What asks is judged here, whatever bus it came over.
//
// csp: while the drive does not follow, the interpolator stands where the drive's set-point does, so that a controller
// must begin with target = position. A target that is none, lies beyond the ends of the travel or is further from the
// one before than max_velocity allows is an invalid set-point (fault set_point). Two cycles in a row without a target
// are bridged with the acceleration that the motion has; the third is the fault set_points_lost.
// pp: a rising edge of bit 4 offers the target with the profile's values that stand beside it. Bit 5: at once, else
// behind the move under way, one of which waits. A move taken in motion brakes no less than the one before. What lies
// beyond the ends is not acknowledged.
// Another mode is taken when the set-point stands, or while the drive does not follow.
#pragma once

#include <cstdint>

#include "stiction/drive/servo_drive.hpp"
#include "stiction/motion/position_profile.hpp"
#include "stiction/motion/set_point_interpolator.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

struct RemoteAxisConfig {
  using S = FixedSignals;
  SetPointInterpolator::Config interpolation{};  // with the way that max_velocity allows in a cycle
  bool streamed = false;                         // targets of csp come from outside; else csp holds where it is
  S::Position low{}, high{};                     // of targets: the ends of the travel
  PositionProfile::Config profile{};
  PositionProfile::Move fastest{};  // limits of a move; also what a move has that nobody gave values for
  S::Position target_window{};      // about the target, within which it is reached
};

class RemoteAxis {
 public:
  using S = FixedSignals;
  static constexpr int cycles_bridged = 2;

  explicit constexpr RemoteAxis(const RemoteAxisConfig& config)
      : config_(config), interpolator_(config.interpolation), profile_(config.profile), asked_move_(config.fastest) {}

  // What is asked for; holds until changed.
  constexpr void ask(std::uint16_t controlword) { controlword_ = controlword; }
  constexpr void ask(OperationMode mode) { asked_mode_ = mode; }
  // pp. `valid`: the bus gave a number that the formats hold; no move goes to another one.
  constexpr void ask_target(S::Position target, bool valid = true) {
    asked_move_.target = target;
    has_target_ = valid;
  }
  // Magnitudes, the last two a tick; held to the machine's limits.
  constexpr void ask_velocity(S::Velocity v) { asked_move_.velocity = within(v, config_.fastest.velocity); }
  constexpr void ask_acceleration(S::Velocity change) {
    asked_move_.acceleration = within(change, config_.fastest.acceleration);
  }
  constexpr void ask_deceleration(S::Velocity change) {
    asked_move_.deceleration = within(change, config_.fastest.deceleration);
  }
  // csp: as cyclic as the targets are, forgotten after as many cycles.
  constexpr void ask_offsets(S::Velocity velocity, S::Current current) {
    velocity_offset_ = velocity;
    current_offset_ = current;
    offset_age_ = 0;
  }
  // csp: a target of this cycle; the newest counts. `valid`: the bus gave a number that the formats hold.
  constexpr void offer(S::Position target, bool valid) {
    offered_ = target;
    offered_valid_ = valid;
    if (offers_ < cycles_bridged + 1) ++offers_;
  }

  // When a cycle begins, with what came for it.
  constexpr void begin_cycle() {
    const bool came = offers_ > 0;
    const int cycles = came && offers_ > missed_ ? offers_ : missed_ + 1;  // that the way may have taken
    if (!came && missed_ <= cycles_bridged) ++missed_;
    if (came) missed_ = 0;
    offers_ = 0;
    if (offset_age_ <= cycles_bridged)
      ++offset_age_;
    else
      forget_offsets();
    if (!following_ || mode_ != OperationMode::cyclic_position || !config_.streamed) return;
    if (!came) return interpolator_.extrapolate();
    valid_ = offered_valid_ && reachable(offered_) && near(offered_, cycles);
    // What is refused does not become a reference.
    if (!valid_) return interpolator_.extrapolate();
    received_ = offered_;
    interpolator_.take(offered_);
  }

  // The set-point of the coming tick. `drive`: a ServoDrive, or what tells the same of one, as the last tick left it.
  template <class Drive>
  constexpr SetPoint<S> tick(const Drive& drive) {
    const auto stands = drive.set_position();
    const bool follows = drive.follows();
    const bool at_rest = mode_ == OperationMode::cyclic_position ? interpolator_.at_rest() : profile_.at_rest();
    const bool changes = asked_mode_ != mode_ && (!follows || at_rest);
    if (changes) mode_ = asked_mode_;
    // Another one begins where the last one ended.
    if (!follows || changes || !following_) begin(stands);
    following_ = follows;
    faulted_ = drive.fault() == Fault::set_points_lost;
    x_ = drive.position();
    const bool edge = take_edge() && follows;
    if (mode_ != OperationMode::profile_position) return csp_set_point();
    if (edge) offer_move();
    if (waits_ && profile_.arrived()) go(waiting_);
    const auto point = profile_.step((controlword_ & controlword::halt_bit) != 0);
    return {point.position, point.velocity, point.acceleration};
  }

  constexpr std::uint16_t controlword() const { return controlword_; }
  constexpr OperationMode mode() const { return mode_; }                       // 6061h
  constexpr const PositionProfile::Move& move() const { return asked_move_; }  // the values asked for
  constexpr S::Velocity velocity_offset() const {
    return mode_ == OperationMode::cyclic_position ? velocity_offset_ : S::Velocity{};
  }

  // Of the coming tick; as long as its cause does.
  constexpr Fault fault() const {
    const bool wanted = config_.streamed && mode_ == OperationMode::cyclic_position && (following_ || faulted_);
    return wanted && missed_ > cycles_bridged ? Fault::set_points_lost : Fault::none;
  }

  // The drive's, with the bits of pp.
  constexpr std::uint16_t statusword(std::uint16_t of_drive) const {
    if (mode_ != OperationMode::profile_position) return of_drive;
    const bool halted = (controlword_ & controlword::halt_bit) != 0;
    const bool near_target = !exceeds_window();
    if (halted ? profile_.at_rest() : profile_.arrived() && !waits_ && near_target) of_drive |= statusword::target_bit;
    if (acknowledged_ || waits_) of_drive |= statusword::acknowledge_bit;
    if (refused_) of_drive |= statusword::limit_bit;
    return of_drive;
  }

 private:
  constexpr void forget_offsets() {
    velocity_offset_ = {};
    current_offset_ = {};
  }
  static constexpr S::Velocity within(S::Velocity asked, S::Velocity most) {
    return asked < S::Velocity::from_raw(1) ? S::Velocity::from_raw(1) : asked > most ? most : asked;
  }

  constexpr void begin(S::Position position) {
    interpolator_.start(position);
    profile_.start(position);
    received_ = position;
    valid_ = true;
    waits_ = acknowledged_ = refused_ = false;
  }

  constexpr bool reachable(S::Position target) const { return target >= config_.low && target <= config_.high; }
  constexpr bool near(S::Position target, int cycles) const {
    const auto way = target.raw() - received_.raw();  // both within the travel
    const auto most = config_.interpolation.largest_way.raw() * cycles;
    return way <= most && way >= -most;
  }
  constexpr bool exceeds_window() const {
    const auto off = x_.raw() - profile_.move().target.raw();
    return off > config_.target_window.raw() || off < -config_.target_window.raw();
  }

  constexpr SetPoint<S> csp_set_point() {
    const auto point = interpolator_.step();
    SetPoint<S> set{point.position, point.velocity, point.acceleration};
    set.valid = valid_;
    set.injection = current_offset_;
    return set;
  }

  constexpr bool take_edge() {
    const bool bit = (controlword_ & controlword::new_set_point_bit) != 0;
    const bool edge = bit && !bit_before_;
    bit_before_ = bit;
    if (!bit) acknowledged_ = refused_ = false;
    return edge;
  }

  constexpr void offer_move() {
    auto move = asked_move_;
    if ((controlword_ & controlword::relative_bit) != 0) {
      const auto& before = waits_ ? waiting_ : profile_.move();
      move.target = narrow<S::Position>(before.target + asked_move_.target, saturations_);
    }
    refused_ = !has_target_ || !reachable(move.target);
    if (refused_) return;
    const bool at_once = (controlword_ & controlword::at_once_bit) != 0;
    if (at_once && !profile_.at_rest() && move.deceleration < profile_.move().deceleration)
      move.deceleration = profile_.move().deceleration;  // else it might not stop before the end of the travel
    if (at_once || profile_.arrived()) return go(move);
    if (waits_) return;  // no room: not acknowledged anew
    waiting_ = move;
    waits_ = true;
  }
  constexpr void go(const PositionProfile::Move& move) {
    profile_.go(move);
    acknowledged_ = bit_before_;
    waits_ = false;
  }

  RemoteAxisConfig config_;
  SetPointInterpolator interpolator_;
  PositionProfile profile_;
  PositionProfile::Move asked_move_;
  std::uint16_t controlword_ = controlword::disable_voltage;
  OperationMode asked_mode_ = OperationMode::cyclic_position, mode_ = OperationMode::cyclic_position;
  S::Velocity velocity_offset_{};
  S::Current current_offset_{};
  // csp
  S::Position offered_{}, received_{};
  int offers_ = 0, missed_ = 0;  // in this cycle; cycles in a row without one
  int offset_age_ = 0;           // cycles
  bool offered_valid_ = false, valid_ = true;
  // pp
  PositionProfile::Move waiting_{};
  bool has_target_ = false, bit_before_ = false, acknowledged_ = false, waits_ = false, refused_ = false;
  // The drive in the last tick.
  S::Position x_{};
  bool following_ = false, faulted_ = false;
  SaturationCounter saturations_;
};

}  // namespace stiction
