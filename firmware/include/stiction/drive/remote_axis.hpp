// An axis that others command over a bus, from what they ask for to its set-point in each tick: cyclic synchronous
// position, velocity and torque (csp, csv, cst) from targets that come each cycle, profile position and velocity (pp,
// pv) from one target at a time, as CiA 402 (IEC 61800-7-201) has them. What asks is judged here, whatever bus it came
// over.
//
// csp: while the drive does not follow, the interpolator stands where the drive's set-point does, so that a controller
// must begin with target = position. A target that is none, lies beyond the ends of the travel or is further from the
// one before than max_velocity and max_acceleration allow is an invalid set-point (fault set_point). Two cycles in a
// row without a target are bridged with the acceleration that the motion has; the third is the fault set_points_lost.
// What the interpolated targets ask of the set speed beyond max_acceleration is made up for later
// (speed_step_limit.hpp); a lag of more than the window of the following error is an invalid set-point as well. pp: a
// rising edge of bit 4 offers the target with the profile's values that stand beside it. Bit 5: at once, else behind
// the move under way, one of which waits. A move taken in motion brakes no less than the one before. What lies beyond
// the ends is not acknowledged, and no absolute target is where the zero of the axis is not known. pv, csv: a move
// towards the end of the travel with the speed asked for, so that the axis brakes before the end; csv with the
// machine's limits, without smoothing, and with the watch of csp over its cycles. Without a zero there are no ends. An
// axis beyond an end may go back in every mode, and no further out. Another mode is taken when the set-point stands, or
// while the drive does not follow. A move of pp is ended first, a cam is left; every other mode brakes.
#pragma once

#include <cstdint>

#include "stiction/drive/asked_values.hpp"
#include "stiction/drive/command_owner.hpp"
#include "stiction/drive/refusal.hpp"
#include "stiction/drive/remote_axis_config.hpp"
#include "stiction/drive/remote_cam.hpp"
#include "stiction/drive/servo_drive.hpp"
#include "stiction/drive/torque_mode.hpp"
#include "stiction/motion/position_profile.hpp"
#include "stiction/motion/set_point_interpolator.hpp"
#include "stiction/motion/speed_step_limit.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

class RemoteAxis {
 public:
  using S = FixedSignals;
  static constexpr int cycles_bridged = 2;

  explicit constexpr RemoteAxis(const RemoteAxisConfig& config)
      : config_(config),
        owner_(config.owner),
        interpolator_(config.interpolation),
        step_limit_(config.step_limit),
        profile_(config.profile),
        torque_(config.torque),
        asked_move_(config.fastest) {}

  // A controlword of a source; holds until changed. False: refused, as a different one owns the axis. `of_other`: as of
  // CommandOwner::command().
  constexpr bool ask(std::uint16_t controlword, CommandSource source = CommandSource::can, bool of_other = false) {
    return owner_.command(source, controlword, of_other);
  }
  // Who commands it. Sources whose values owner().accepts() not are to be kept off by who calls what follows.
  constexpr const CommandOwner& owner() const { return owner_; }
  constexpr void hear(CommandSource source) { owner_.hear(source); }
  constexpr void disconnect(CommandSource source) { owner_.disconnect(source); }
  // What is asked for; holds until changed.
  constexpr void ask(OperationMode mode) {
    if (!is_coupled(mode) || cam_.attached()) asked_mode_ = mode;
  }
  // pp. `valid`: the bus gave a number that the formats hold; no move goes to another one.
  constexpr void ask_target(S::Position target, bool valid = true) {
    asked_move_.target(target);
    has_target_ = valid;
  }
  // Magnitudes, the last two a tick; held to the machine's limits.
  constexpr void ask_velocity(S::Velocity v) { asked_move_.velocity(v); }
  constexpr void ask_acceleration(S::Velocity change) { asked_move_.acceleration(change); }
  constexpr void ask_deceleration(S::Velocity change) { asked_move_.deceleration(change); }
  // pv: 60FFh, held to the machine's limit.
  constexpr void ask_speed(S::Velocity v) {
    const auto most = config_.fastest.velocity, least = opposite(most);
    asked_speed_ = v > most ? most : v < least ? least : v;
  }
  // cst: 6071h.
  constexpr void ask_torque(S::Current current) { asked_torque_ = current; }
  // 6072h, held to the current limit of the axis.
  constexpr void ask_most_torque(S::Current current) { torque_.limit_to(current); }
  // csp, and the current in cst: as cyclic as the targets are, forgotten after as many cycles.
  constexpr void ask_offsets(S::Velocity velocity, S::Current current) { offsets_.take(velocity, current); }
  constexpr RemoteCam& cam() { return cam_; }
  constexpr const RemoteCam& cam() const { return cam_; }
  constexpr void ask(CamCommand command) { cam_.command(command, mode_, following_, referenced_); }
  // csp: a target of this cycle; the newest counts. `valid`: the bus gave a number that the formats hold.
  constexpr void offer(S::Position target, bool valid) {
    offered_ = target;
    came_ |= bit_of(OperationMode::cyclic_position);
    offered_valid_ = valid;
  }
  // csv: the same, and a speed of pv as well.
  constexpr void offer_speed(S::Velocity speed, bool valid) {
    if (valid) ask_speed(speed);
    came_ |= bit_of(OperationMode::cyclic_velocity);
    speed_valid_ = valid;
  }
  // cst: the same of a current; every number that a bus can send is one.
  constexpr void offer_torque(S::Current current) {
    ask_torque(current);
    came_ |= bit_of(OperationMode::cyclic_torque);
  }

  // When a cycle begins, with what came for it.
  constexpr void begin_cycle() {
    const bool came = (came_ & bit_of(is_cyclic(mode_) ? mode_ : OperationMode::cyclic_position)) != 0;
    const bool came_speed = (came_ & bit_of(OperationMode::cyclic_velocity)) != 0;
    came_ = 0;
    if (came_speed && mode_ == OperationMode::profile_velocity) {
      refusal_ = speed_valid_ ? Refusal::none : Refusal::no_number;  // the speed before it holds
      refused_ = !speed_valid_;
    }
    if (!came && missed_ <= cycles_bridged) ++missed_;
    if (came) missed_ = 0;
    offsets_.begin_cycle();
    // Held without a zero, it refuses what is not where it stands.
    if (came && mode_ == OperationMode::cyclic_position && !referenced_) {
      refusal_ = offered_valid_ && within_window(offered_, x_) ? Refusal::none : Refusal::no_reference;
      refused_ = refusal_ != Refusal::none;
    }
    if (!following_ || !is_cyclic(mode_) || !streams()) return;
    if (mode_ != OperationMode::cyclic_position) {
      valid_ = mode_ == OperationMode::cyclic_torque || !came || speed_valid_;
      return;
    }
    if (!came) return interpolator_.extrapolate();
    valid_ = offered_valid_ && config_.allows(offered_, interpolator_.target()) && interpolator_.can_take(offered_);
    // What is refused does not become a reference.
    if (!valid_) return interpolator_.extrapolate();
    interpolator_.take(offered_);
  }

  // The set-point of the coming tick. `drive`: a ServoDrive, or what tells the same of one, as the last tick left it.
  template <class Drive>
  constexpr SetPoint<S> tick(const Drive& drive) {
    owner_.tick(drive.powered());
    controlword_ = owner_.word();
    const auto stands = drive.set_position();
    const bool follows = drive.follows();
    const bool at_rest = drive.set_velocity() == S::Velocity{} && (!follows || source_rests());
    const bool changes = asked_mode_ != mode_ && at_rest;
    stops_along_ = drive.stops_along();
    stops_fast_ = drive.stops_fast();
    referenced_ = drive.referenced();
    standing_ = drive.standing();
    // Behind a change too: a speed of before is none of the mode that follows.
    if (changes) take_mode();
    // Another one begins where the last one ended.
    if (!follows || changes || !following_) {
      begin(stands);
      torque_.start(drive.set_current(), drive.position());
    }
    following_ = follows;
    faulted_ = drive.fault() == Fault::set_points_lost;
    x_ = drive.position();
    const bool leaves = asked_mode_ != mode_ && mode_ != OperationMode::profile_position && !is_coupled(mode_);
    brakes_ = leaves || (mode_ == OperationMode::cyclic_position && streams() && !referenced_);
    v_ = drive.velocity();
    const bool edge = take_edge() && follows;
    auto set = set_point_of_mode(edge);
    set.limits_current = torque_.is_limited();
    set.most_current = torque_.most();
    return set;
  }

  constexpr std::uint16_t controlword() const { return owner_.word(); }
  constexpr OperationMode mode() const { return mode_; }                              // 6061h
  constexpr const PositionProfile::Move& move() const { return asked_move_.move(); }  // asked for
  constexpr S::Velocity speed() const { return asked_speed_; }                        // 60FFh
  constexpr S::Current torque() const { return asked_torque_; }                       // 6071h
  constexpr S::Current most_torque() const { return torque_.most(); }                 // 6072h
  constexpr S::Current rated_torque() const { return config_.torque.most; }  // of which torques are thousandths
  constexpr Refusal refusal() const { return refusal_; }  // of the last target, until one is taken or bit 4 falls
  // Whether the drive is to brake to standstill in the coming tick, in place of its set-point.
  constexpr bool brakes() const { return brakes_; }
  // Whether a stop of the drive may follow the set-point in place of a ramp.
  constexpr bool along() const { return is_coupled(mode_) && cam_.along(); }
  constexpr S::Velocity velocity_offset() const {
    return mode_ == OperationMode::cyclic_position ? offsets_.velocity() : S::Velocity{};
  }

  // Of the coming tick; as long as its cause does.
  constexpr Fault fault() const {
    if (owner_.fault() != Fault::none) return owner_.fault();
    if (is_coupled(mode_) && following_ && cam_.fault() != Fault::none) return cam_.fault();
    const bool wanted = is_cyclic(mode_) && (faulted_ || (streams() && following_));
    return wanted && missed_ > cycles_bridged ? Fault::set_points_lost : Fault::none;
  }

  // The drive's, with the bits of the mode.
  constexpr std::uint16_t statusword(std::uint16_t of_drive) const {
    const bool refused = is_coupled(mode_) ? cam_.refused() : refused_;
    if (refused) of_drive |= statusword::limit_bit | statusword::warning_bit;
    if (is_coupled(mode_)) of_drive |= cam_.bits();
    if (mode_ == OperationMode::profile_position) of_drive |= bits_of_move();
    if (mode_ == OperationMode::profile_velocity) of_drive |= bits_of_speed();
    const bool held_back = mode_ == OperationMode::cyclic_torque && following_ && torque_.held_back();
    if (at_end_ || held_back) of_drive |= statusword::limit_bit;
    return of_drive;
  }

 private:
  // Of came_.
  static constexpr unsigned bit_of(OperationMode mode) { return 1u << static_cast<unsigned>(mode); }
  // A PLC gives no targets each cycle: in csp its axis holds. One that nobody owns is being stopped.
  constexpr bool streams() const { return config_.streamed && owner_.owner() == CommandSource::can; }
  constexpr bool halted() const { return (controlword_ & controlword::halt_bit) != 0; }
  constexpr bool source_rests() const {
    if (mode_ == OperationMode::cyclic_torque) return false;
    if (is_coupled(mode_)) return cam_.at_rest();
    if (mode_ != OperationMode::cyclic_position) return profile_.at_rest();
    return interpolator_.at_rest();  // a rest of its lag is given up
  }

  constexpr void take_mode() {
    mode_ = asked_mode_;
    asked_speed_ = {};
    asked_torque_ = {};
    refused_ = false;
    refusal_ = Refusal::none;
  }

  constexpr void begin(S::Position position) {
    interpolator_.start(position);
    step_limit_.start(position);
    profile_.start(position, mode_ != OperationMode::cyclic_velocity);
    cam_.start(position);
    point_ = {position, {}, {}};
    valid_ = true;
    waits_ = acknowledged_ = at_end_ = false;
  }

  static constexpr S::Velocity larger(S::Velocity a, S::Velocity b) { return a < b ? b : a; }
  constexpr bool within_window(S::Position a, S::Position b) const {
    const auto off = a.raw() - b.raw();
    return off <= config_.target_window.raw() && off >= -config_.target_window.raw();
  }

  constexpr SetPoint<S> set_point_of_mode(bool edge) {
    switch (mode_) {
      case OperationMode::profile_position:
        return move_set_point(edge);
      case OperationMode::profile_velocity:
      case OperationMode::cyclic_velocity:
        return speed_set_point();
      case OperationMode::cyclic_torque:
        return torque_set_point();
      case OperationMode::cam:
      case OperationMode::gear:
        return cam_set_point();
      default:
        return csp_set_point();
    }
  }

  // A position beyond an end is an invalid set-point, as in csp.
  constexpr SetPoint<S> cam_set_point() {
    const bool fast = stops_along_ ? stops_fast_ : config_.halting != S::Velocity{};
    auto set = cam_.step(stops_along_ || halted() || asked_mode_ != mode_, following_,
                         fast ? CamStop::quick_stop : CamStop::slow_down, stops_along_);
    set.valid = set.valid && (!referenced_ || config_.allows(set.position, point_.position));
    point_ = {set.position, set.velocity, set.acceleration};
    return set;
  }

  // Position and speed are the drive's to show.
  constexpr SetPoint<S> torque_set_point() {
    SetPoint<S> set{point_.position, {}, {}};
    const auto target = saturated_sum(asked_torque_, offsets_.current(), saturations_);
    if (following_) set.injection = torque_.step(target, {x_, v_, referenced_});
    set.by_current = following_;
    set.valid = valid_;
    return set;
  }

  constexpr SetPoint<S> csp_set_point() {
    const auto wanted = interpolator_.step();
    const auto point = step_limit_.step({wanted.position, wanted.velocity, wanted.acceleration});
    const bool valid = valid_ && step_limit_.follows();
    return {point.position, point.velocity, point.acceleration, valid, offsets_.current()};
  }

  constexpr SetPoint<S> profile_set_point(bool halt) {
    point_ = profile_.step(halt, config_.halting);
    return {point_.position, point_.velocity, point_.acceleration, valid_};
  }

  constexpr SetPoint<S> move_set_point(bool edge) {
    if (edge) offer_move();
    if (waits_ && profile_.arrived()) go(waiting_);
    return profile_set_point(halted());
  }

  // A cyclic speed changes by the machine's limits, one of pv by its profile.
  constexpr SetPoint<S> speed_set_point() {
    auto move = mode_ == OperationMode::cyclic_velocity ? config_.fastest : asked_move_.move();
    constexpr S::Velocity still{};
    const bool down = asked_speed_ < still;
    const bool up = asked_speed_ > still;
    const auto beyond = down ? point_.position <= config_.low : up && point_.position >= config_.high;
    at_end_ = referenced_ && beyond;
    move.velocity = down ? opposite(asked_speed_) : asked_speed_;
    move.deceleration = planned(move.deceleration);
    move.target = referenced_ ? (down ? config_.low : config_.high) : far(down);
    // While it halts the move stays the one that it brakes from; a motion begins where the drive follows.
    const bool halt = halted() || at_end_ || !(down || up) || !following_;
    if (!profile_.at_rest()) move.deceleration = larger(move.deceleration, profile_.move().deceleration);
    if (!halt && !(move == profile_.move())) profile_.go(move);
    return profile_set_point(halt);
  }
  // Where nothing says how far the travel goes.
  constexpr S::Position far(bool down) const {
    constexpr std::int64_t way = std::int64_t{60} << 40;  // m; the profile holds 128 m from one end to the other
    return S::Position::from_raw(profile_.base().raw() + (down ? -way : way));
  }

  constexpr std::uint16_t bits_of_move() const {
    std::uint16_t bits = 0;
    const bool near_target = within_window(x_, profile_.move().target);
    if (halted() ? profile_.at_rest() : profile_.arrived() && !waits_ && near_target) bits |= statusword::target_bit;
    if (acknowledged_ || waits_) bits |= statusword::acknowledge_bit;
    return bits;
  }
  constexpr std::uint16_t bits_of_speed() const {
    std::uint16_t bits = 0;
    const auto wanted = halted() || at_end_ ? S::Velocity{} : asked_speed_;
    if (point_.velocity == wanted && following_) bits |= statusword::target_bit;
    if (standing_) bits |= statusword::speed_zero_bit;
    return bits;
  }

  constexpr bool take_edge() {
    const bool bit = (controlword_ & controlword::new_set_point_bit) != 0;
    const bool edge = bit && !bit_before_;
    bit_before_ = bit;
    if (!bit) acknowledged_ = false;
    if (!bit && mode_ == OperationMode::profile_position) refused_ = false;
    return edge;
  }

  constexpr void offer_move() {
    auto move = asked_move_.move();
    move.deceleration = planned(move.deceleration);
    const bool relative = (controlword_ & controlword::relative_bit) != 0;
    if (relative) {
      const auto& before = waits_ ? waiting_ : profile_.move();
      move.target = narrow<S::Position>(before.target + move.target, saturations_);
    }
    refusal_ = !has_target_                                                   ? Refusal::no_number
               : !referenced_ && !relative                                    ? Refusal::no_reference
               : referenced_ && !config_.allows(move.target, point_.position) ? Refusal::beyond_end
                                                                              : Refusal::none;
    refused_ = refusal_ != Refusal::none;
    if (refused_) return;
    const bool at_once = (controlword_ & controlword::at_once_bit) != 0;
    // Else it might not stop before the end of the travel.
    if (at_once && !profile_.at_rest()) move.deceleration = larger(move.deceleration, profile_.move().deceleration);
    if (at_once || profile_.arrived()) return go(move);
    if (waits_) return;  // no room: not acknowledged again
    waiting_ = move;
    waits_ = true;
  }
  // Less where the end of a braking would take more than is asked for (position_profile.hpp).
  constexpr S::Velocity planned(S::Velocity deceleration) const {
    if (profile_.keeps_deceleration()) return deceleration;
    return S::Velocity::from_bounded_raw(deceleration.raw() - (deceleration.raw() >> 3));
  }
  constexpr void go(const PositionProfile::Move& move) {
    profile_.go(move);
    acknowledged_ = bit_before_;
    waits_ = false;
  }

  RemoteAxisConfig config_;
  CommandOwner owner_;
  SetPointInterpolator interpolator_;
  SpeedStepLimit step_limit_;
  PositionProfile profile_;
  TorqueMode torque_;
  RemoteCam cam_;
  AskedMove asked_move_;
  std::uint16_t controlword_ = controlword::disable_voltage;
  OperationMode asked_mode_ = OperationMode::cyclic_position, mode_ = OperationMode::cyclic_position;
  S::Velocity asked_speed_{};
  S::Current asked_torque_{};
  // csp, csv, cst
  S::Position offered_{};
  unsigned came_ = 0;  // in this cycle
  int missed_ = 0;     // cycles in a row without one
  CyclicOffsets<cycles_bridged> offsets_;
  bool offered_valid_ = false, speed_valid_ = false, valid_ = true;
  // pp, pv, csv
  PositionProfile::Move waiting_{};
  PositionProfile::Point point_{};
  bool has_target_ = false, bit_before_ = false, acknowledged_ = false, waits_ = false;
  bool at_end_ = false, brakes_ = false, refused_ = false;
  Refusal refusal_ = Refusal::none;
  // The drive in the last tick.
  S::Position x_{};
  S::Velocity v_{};
  bool stops_along_ = false, stops_fast_ = false;
  bool following_ = false, faulted_ = false, referenced_ = true, standing_ = true;
  SaturationCounter saturations_;
};

}  // namespace stiction
