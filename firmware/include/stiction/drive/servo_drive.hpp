// One axis as a drive: the state machine of CiA 402, the supervision, homing, controlled stops and the brake around the
// cascade. before() a tick gives the cascade its set-point, starts and stops it; after() it takes over what the
// cascade itself found. The cascade runs in the encoder's coordinates; set-points of outside and position() are the
// machine's, which homing shifts.
//
// While the power stage is off the set-point follows the measured position, so that an enabled axis begins where it
// stands; an axis that moves is not enabled. A fault whose reaction is a quick stop ends in a stop by the ramp; any
// other fault on the way takes the power off at once, as does a following error that the control itself drives up
// (Supervision::resisted), and so does a stop that is not over stop_margin_ticks after its
// set-point came to rest. Whatever is asked for, the speed of the set-point changes by the ramps here or by those of
// its source (remote_axis.hpp), or the power goes: what is left or halted in motion brakes to rest before anything else
// is followed, and an offset of the speed comes and goes with what of most_change the set-point leaves.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/limit.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/force_current.hpp"
#include "stiction/drive/holding_brake.hpp"
#include "stiction/drive/homing.hpp"
#include "stiction/drive/lag_watch.hpp"
#include "stiction/drive/rest_watch.hpp"
#include "stiction/drive/servo_drive_config.hpp"
#include "stiction/drive/speed_offset.hpp"
#include "stiction/drive/state_machine.hpp"
#include "stiction/drive/supervision.hpp"
#include "stiction/motion/velocity_ramp.hpp"

namespace stiction {

template <class S>
class ServoDrive {
 public:
  using Position = typename S::Position;
  using Velocity = typename S::Velocity;
  using Ramp = VelocityRamp<S>;

  // Ticks of a healthy axis at rest before the drive is ready: a current sensor's offset shows in it.
  static constexpr std::uint8_t self_test_ticks = RestWatch<S>::ticks;
  // 10 ms at 62.5 us: a loop that settles passes through zero speed on its way.
  static constexpr std::uint8_t standstill_ticks = 160;

  explicit constexpr ServoDrive(const ServoDriveConfig<S>& config)
      : config_(config),
        machine_({.hold_after_quick_stop = stop_way(StopObject::quick_stop, config.stops.quick_stop).held}),
        supervision_(config.supervision),
        homing_(config.homing),
        commutation_(config.commutation),
        brake_test_(config.brake_test) {
    referenced_ = config.homing.method == HomingMethod::none;
  }

  // Takes the power off and begins with the self-test. Before the first tick, with its feedback.
  constexpr void start(const Feedback<S>& feedback, Axis<S>& axis) {
    measured_ = feedback.position;
    rest_.start(measured_);
    measured_ns_ = feedback.position_time_ns;
    last_ = {feedback.position, {}};
    axis.start(feedback);
    axis.stop();
    if (commutation_.used()) axis.commutate(commutation_.offset());
  }

  // The set-point of this tick for the cascade. Its power is on or off as the drive's state says. `demand`:
  // controlword, mode and set-point from outside; `feedback`: newest position, currents and fault inputs; `inputs`:
  // switches and index; `now_ns`: time of the tick; `axis`: the cascade, which is started and stopped here.
  constexpr SetPoint<S> before(const DriveDemand<S>& demand, const Feedback<S>& feedback,
                               const DigitalInputs<S>& inputs, std::int64_t now_ns, Axis<S>& axis) {
    events_ = {};
    fault_raised_ = false;
    now_ns_ = now_ns;
    supplied_ = !feedback.fault;
    const Fault supervised = supervision_.step(seen(feedback, inputs, now_ns, axis));
    if (supervision_.fresh()) {
      measured_ = feedback.position;
      measured_ns_ = feedback.position_time_ns;
    }
    rest_.step(measured_, config_.standstill_way);
    if (commutation_.used()) [[unlikely]]
      commutation_.watch(measured_, inputs);
    const bool unfound = homing_.phase() == Homing<S>::Phase::failed;
    bool present = cause_holds(demand, feedback, axis);
    // One by one: a cause that stays must not hide another one.
    for (const Fault fault : demand.causes) present |= raise(fault, now_ns, axis);
    present |= raise(supervised, now_ns, axis);
    present |= raise(unfound ? Fault::homing : Fault::none, now_ns, axis);
    // Not present: a reset lets the next enabling try again.
    raise(commutation_.fault(), now_ns, axis);
    raise(brake_test_.slipped() ? Fault::brake_slips : Fault::none, now_ns, axis);
    // What the control drives up cannot be braked by it, from the beginning of the stop (raise) or on the way.
    if (stopping_ && fault_ == Fault::following_error && supervision_.resisted()) power_off(axis);
    // Before the cascade sees it, so that a ramp takes the place of what is no set-point.
    raise(follows_ && !demand.set_point.valid ? Fault::set_point : Fault::none, now_ns, axis);
    self_test_ = present ? 0 : one_more(self_test_, self_test_ticks);
    advance_states(demand, feedback, present, inputs, axis);
    const auto set = set_point(demand, inputs);
    if (commutation_.used()) [[unlikely]] {
      if (commutation_.searching())
        axis.give_vector(commutation_.order().angle);
      else
        axis.commutate(commutation_.offset());
    }
    return set;
  }

  // Of the tick that the cascade has made.
  constexpr void after(const AxisSignals<S>& signals, Axis<S>& axis) {
    standing_ = exceeds(signals.v, config_.standstill_speed) ? 0 : one_more(standing_, standstill_ticks);
    v_ = signals.v;
    i_set_ = signals.i_set;
    limited_ = powered_ && limits_current_ && signals.limiting.current;
    events_ = {};
    fault_raised_ = false;
    const bool lags = lag_.step(powered_, signals.e, config_.following_error, config_.following_error_ticks);
    if (axis.fault() != Fault::none) {
      if (axis.fault() != fault_) raise(axis.fault(), axis.fault_time_ns(), axis);
      if (powered_) power_off(axis);  // the cascade has done so
    } else if (lags) {
      raise(Fault::following_error, now_ns_, axis);
    }
    if (fault_raised_) machine_.step(controlword_, {.fault = true});
  }

  constexpr DriveState state() const { return machine_.state(); }
  constexpr Fault fault() const { return fault_; }  // the first one, latched until a reset is taken
  constexpr bool powered() const { return powered_; }
  constexpr bool brake_released() const { return powered_ && !brake_.closing() && !preparing(); }
  // Whether commutation or brake are tested, under power, before the axis follows anything.
  constexpr bool preparing() const { return commutation_.searching() || brake_test_.testing(); }
  constexpr const CommutationSearch<S>& commutation() const { return commutation_; }
  constexpr const BrakeTest<S>& brake_test() const { return brake_test_; }
  constexpr bool referenced() const { return referenced_; }
  constexpr bool follows() const { return follows_; }  // the set-points from outside, in the last tick
  // Whether it stops, and goes on to follow set-points that lead to standstill; by which ramp it would stop else.
  constexpr bool stops_along() const { return stopping_ && along_; }
  constexpr bool stops_fast() const { return fast_; }
  constexpr Position origin() const { return origin_; }  // of the machine's coordinates in the encoder's
  constexpr Position position() const { return to_machine(measured_); }
  // Where the set-point stands, machine's coordinates: where a source of set-points begins after enabling or homing.
  constexpr Position set_position() const { return to_machine(last_.position); }
  constexpr Velocity set_velocity() const { return last_.velocity; }
  constexpr Velocity velocity() const { return v_; }                    // measured
  constexpr typename S::Current set_current() const { return i_set_; }  // of the last tick
  constexpr bool standing() const { return rest_.at_rest(); }           // measured
  // Of the last call, before() or after(): the first fault and the one on top of it; Fault::none: nothing happened.
  constexpr const std::array<DriveEvent<S>, 2>& events() const { return events_; }
  constexpr typename Homing<S>::Phase homing_phase() const { return homing_.phase(); }

  constexpr std::uint16_t statusword() const {
    std::uint16_t word = statusword::of(machine_.state());
    if (supplied_) word |= statusword::voltage_bit;
    if (!referenced_) word |= statusword::unreferenced_bit;
    if (torque_off_) word |= statusword::torque_off_bit;
    if (mode_ == OperationMode::homing)
      return static_cast<std::uint16_t>(word |
                                        homing_.status_bits(fault_ == Fault::homing, last_.velocity == Velocity{}));
    if (follows_ && is_cyclic(mode_)) word |= statusword::follows_bit;
    if (shows_following_error()) word |= statusword::following_error_bit;
    if (limited_) word |= statusword::limit_bit;
    return word;
  }

 private:
  constexpr Position to_machine(Position x) const {
    SaturationCounter none;
    return narrow<Position>(x - origin_, none);
  }

  static constexpr std::uint8_t one_more(std::uint8_t ticks, std::uint8_t most) {
    return ticks < most ? static_cast<std::uint8_t>(ticks + 1) : ticks;
  }

  // As long as the fault is latched: without power the error itself is none.
  constexpr bool shows_following_error() const {
    const bool has_bit = mode_ == OperationMode::profile_position || mode_ == OperationMode::profile_velocity ||
                         mode_ == OperationMode::cyclic_position || is_coupled(mode_);
    return has_bit && (fault_ == Fault::following_error || following_ == Fault::following_error);
  }

  constexpr typename Supervision<S>::Seen seen(const Feedback<S>& feedback, const DigitalInputs<S>& inputs,
                                               std::int64_t now_ns, const Axis<S>& axis) {
    typename Supervision<S>::Seen seen{};
    seen.feedback = feedback;
    seen.inputs = inputs;
    seen.now_ns = now_ns;
    seen.powered = powered_;
    // A current at an angle that is not known tells nothing of the force.
    if (!commutation_.searching())
      seen.current = force_current(axis.config(), feedback, measured_, i_set_, axis.commutation(), saturations_);
    seen.set_position = last_.position;
    seen.set_velocity = last_.velocity;
    seen.referenced = referenced_;
    seen.position = to_machine(feedback.position_valid ? feedback.position : measured_);
    seen.seeks_negative = homing_.seeks_negative();
    seen.seeks_positive = homing_.seeks_positive();
    return seen;
  }

  // Conditions behind faults of the axis that would come back right after a reset.
  constexpr bool cause_holds(const DriveDemand<S>& demand, const Feedback<S>& feedback, const Axis<S>& axis) const {
    const auto& config = axis.config();
    bool holds = feedback.fault || !supervision_.fresh() || (fault_ == Fault::set_point && !demand.set_point.valid);
    for (const auto i : feedback.current) holds |= exceeds(i, config.over_current_fault);
    return holds || exceeds(v_, config.over_speed_fault);
  }

  // Whether there is one.
  constexpr bool raise(Fault fault, std::int64_t now_ns, Axis<S>& axis) {
    if (fault == Fault::none || fault == fault_ || following_ != Fault::none) return fault != Fault::none;
    const bool following = fault_ != Fault::none;
    fault_raised_ = true;
    events_[following ? 1 : 0] = {fault, following, now_ns, position(), last_.velocity};
    (following ? following_ : fault_) = fault;
    const auto* row = description_of(fault);
    const auto way = stop_way(StopObject::fault_reaction, config_.stops.fault_reaction);
    const bool stops = !following && row != nullptr && row->reaction == Reaction::quick_stop && powered_ &&
                       !(fault == Fault::following_error && supervision_.resisted());
    // Whatever an axis with a fault follows, it brakes at once.
    along_ = false;
    if (stops && way.ramp != StopRamp::none) {
      begin_stop(way, axis);
    } else {
      axis.trip(fault, now_ns);
      power_off(axis);
    }
    return true;
  }

  // A stop that is under way is never made slower.
  // Nor is one begun that would control a position before its time.
  constexpr void begin_stop(const StopOption& way, Axis<S>& axis, bool along = false) {
    if (way.ramp == StopRamp::none || preparing()) return power_off(axis);
    const bool faster = way.ramp == StopRamp::quick_stop && !fast_;
    along_ = stopping_ ? along_ && !faster : along && follows_;
    fast_ = way.ramp == StopRamp::quick_stop || (stopping_ && fast_);
    stopping_ = true;
  }

  constexpr void power_off(Axis<S>& axis) {
    axis.stop();
    homing_.stop();
    commutation_.stop();
    brake_test_.stop();
    powered_ = false;
    stopping_ = false;
    along_ = false;
    fast_ = false;
    follows_ = false;
  }

  constexpr void advance_states(const DriveDemand<S>& demand, const Feedback<S>& feedback, bool present,
                                const DigitalInputs<S>& inputs, Axis<S>& axis) {
    // Homing has set-points of its own, which no other source continues.
    leaves_homing_ = powered_ && mode_ == OperationMode::homing && demand.mode != mode_ && last_.velocity != Velocity{};
    if (!leaves_homing_) mode_ = demand.mode;
    controlword_ = demand.controlword;
    torque_off_ = demand.torque_off;
    // No further than switch on disabled; a reset is let through.
    if (torque_off_) controlword_ = static_cast<std::uint16_t>(controlword_ & controlword::fault_reset_bit);
    const auto before = machine_.state();
    if (before == DriveState::operation_enabled) {
      const auto command = command_of(controlword_);
      if (command == DriveCommand::shutdown)
        begin_stop(stop_way(StopObject::shutdown, config_.stops.shutdown), axis, demand.along);
      else if (command == DriveCommand::switch_on)
        begin_stop(stop_way(StopObject::disable_operation, config_.stops.disable_operation), axis, demand.along);
      // A stop once begun is finished: by its end the set-points have gone on.
      if (stopping_ && command == DriveCommand::enable_operation)
        controlword_ = static_cast<std::uint16_t>(controlword_ & ~controlword::enable_operation_bit);
    }
    const auto taken = machine_.step(controlword_, {.initialised = self_test_ == self_test_ticks,
                                                    .fault = fault_raised_,
                                                    .quick_stop = demand.quick_stop,
                                                    .stop_ended = stop_ended(),
                                                    .standing = standing(),
                                                    .cause_present = present});
    switch (taken) {
      case 4:
        power_on(feedback, inputs, axis);
        break;
      case 11:
        begin_stop(stop_way(StopObject::quick_stop, config_.stops.quick_stop), axis, demand.along);
        break;
      case 15:
        forget(feedback, axis);
        break;
      case 16:
        stopping_ = fast_ = along_ = false;
        brake_.open(config_.brake_ticks);
        break;
      default:
        break;
    }
    const auto now = machine_.state();
    if (powered_ && now != DriveState::operation_enabled && now != DriveState::quick_stop_active &&
        now != DriveState::fault_reaction_active)
      power_off(axis);
  }

  constexpr void power_on(const Feedback<S>& feedback, const DigitalInputs<S>& inputs, Axis<S>& axis) {
    restart(feedback, axis);
    powered_ = true;
    stopping_ = fast_ = along_ = false;
    brake_.open(config_.brake_ticks);
    standing_ = 0;
    last_ = {measured_, {}};
    commutation_.begin(measured_, inputs);
    brake_test_.begin(measured_);
  }

  constexpr void restart(Feedback<S> feedback, Axis<S>& axis) const {
    feedback.position = measured_;  // of a tick that may have brought none
    axis.start(feedback);
  }

  constexpr void forget(const Feedback<S>& feedback, Axis<S>& axis) {
    const bool lost = loses_reference(fault_) || loses_reference(following_);
    if (lost && config_.homing.method != HomingMethod::none) referenced_ = false;
    if (lost) commutation_.lose();
    fault_ = following_ = Fault::none;
    commutation_.forget();
    brake_test_.forget();
    supervision_.restart();
    restart(feedback, axis);
    axis.stop();
  }

  constexpr bool stop_ended() {
    if (!stopping_) return true;
    // A curve may stand on the way.
    if (along_) return false;
    if (last_.velocity != Velocity{} || offset_.speed() != Velocity{}) return false;
    return brake_.close(standing_ == standstill_ticks, config_.stop_margin_ticks, config_.brake_ticks);
  }

  // The set-point of whoever leads, and the offset on top of it.
  constexpr SetPoint<S> set_point(const DriveDemand<S>& demand, const DigitalInputs<S>& inputs) {
    const auto before = last_.velocity;
    auto set = leading_set_point(demand, inputs);
    limits_current_ = set.limits_current;
    const auto change = saturated_difference(last_.velocity, before, saturations_);
    const auto left = config_.most_change - (change < Velocity{} ? opposite(change) : change);
    if (powered_)
      offset_.step(follows_ ? demand.velocity_offset : Velocity{}, narrow<Velocity>(left, saturations_), saturations_);
    else
      offset_ = {};
    set.velocity = saturated_sum(set.velocity, offset_.speed(), saturations_);
    return set;
  }

  constexpr SetPoint<S> leading_set_point(const DriveDemand<S>& demand, const DigitalInputs<S>& inputs) {
    follows_ = false;
    if (!powered_) {
      last_ = {measured_, {}};
      brakes_ = false;
      return {last_.position, {}, {}};
    }
    if (stopping_ && along_ && demand.along && demand.set_point.valid) return followed(demand.set_point);
    along_ = false;
    if (stopping_ || machine_.state() != DriveState::operation_enabled) return ramped({}, stopping_ && !fast_);
    if (preparing() || commutation_.fault() != Fault::none || brake_test_.slipped()) return prepared();
    if (brake_.opens()) return ramped({});
    // Once begun it goes on to rest, as a source of set-points begins there.
    const bool wanted = demand.brake || leaves_homing_ || halted();
    brakes_ = wanted || (brakes_ && last_.velocity != Velocity{});
    if (brakes_) {
      homing_.interrupt();  // a mark that is passed while it brakes is none
      return ramped({}, stop_way(StopObject::halt, config_.stops.halt).ramp == StopRamp::slow_down);
    }
    if (mode_ == OperationMode::homing) return ramped(homing_speed(inputs));
    homing_.stop();
    return followed(demand.set_point);
  }

  constexpr SetPoint<S> followed(SetPoint<S> set) {
    follows_ = true;
    if (set.by_current) {
      // Where the axis is, so that a ramp begins there.
      const auto since = narrow<Position>(v_ * S::seconds(now_ns_ - measured_ns_), saturations_);
      set.position = narrow<Position>(measured_ + since, saturations_);
      set.velocity = v_;
    } else {
      set.position = narrow<Position>(set.position + origin_, saturations_);
    }
    last_ = {set.position, set.velocity};
    return set;
  }

  // A current without control of position, with the brake closed: of a test, or none after one that failed.
  constexpr SetPoint<S> prepared() {
    SetPoint<S> set{measured_, {}, {}};
    last_ = {measured_, {}};
    set.by_current = true;
    if (commutation_.searching()) {
      commutation_.step(measured_, standing());
      set.injection = commutation_.order().current;
    } else if (brake_test_.testing()) {
      set.injection = brake_test_.step(measured_);
    }
    return set;
  }

  // Sources of profiles brake by themselves, in their own deceleration.
  constexpr bool halted() const {
    const bool here = mode_ == OperationMode::homing || mode_ == OperationMode::cyclic_position ||
                      mode_ == OperationMode::cyclic_torque;
    return here && (controlword_ & controlword::halt_bit) != 0;
  }

  constexpr SetPoint<S> ramped(Velocity target, bool slowly = false) {
    auto ramp = config_.ramp;
    if (slowly) ramp.change = config_.slow_down;
    const auto acceleration = Ramp::step(ramp, last_, target, saturations_);
    return {last_.position, last_.velocity, acceleration};
  }

  constexpr Velocity homing_speed(const DigitalInputs<S>& inputs) {
    using Phase = typename Homing<S>::Phase;
    const bool wanted = (controlword_ & controlword::homing_start_bit) != 0;
    if (!wanted) homing_.stop();
    if (wanted && homing_.phase() == Phase::idle) {
      homing_.start(measured_);
      referenced_ = false;
    }
    const auto speed = homing_.step(last_, measured_, inputs);
    if (homing_.phase() == Phase::done && !referenced_) {
      origin_ = homing_.origin();
      referenced_ = true;
    }
    return speed;
  }

  ServoDriveConfig<S> config_;
  StateMachine machine_;
  Supervision<S> supervision_;
  Homing<S> homing_;
  CommutationSearch<S> commutation_;
  BrakeTest<S> brake_test_;

  OperationMode mode_ = OperationMode::cyclic_position;
  std::uint16_t controlword_ = 0;
  Fault fault_ = Fault::none, following_ = Fault::none;
  bool fault_raised_ = false;
  bool powered_ = false, stopping_ = false, follows_ = false, referenced_ = false;
  bool fast_ = false;   // the stop, by the quick-stop ramp
  bool along_ = false;  // it goes on to follow set-points
  bool leaves_homing_ = false, brakes_ = false, supplied_ = true, torque_off_ = false;
  RestWatch<S> rest_;
  LagWatch<S> lag_;
  std::uint8_t self_test_ = 0, standing_ = 0;
  bool limits_current_ = false, limited_ = false;
  HoldingBrake brake_;
  std::int64_t now_ns_ = 0, measured_ns_ = 0;
  Position measured_{}, origin_{};
  Velocity v_{};
  typename S::Current i_set_{};  // of the last tick
  typename Ramp::State last_{};  // the set-point of the last tick, the encoder's coordinates
  SpeedOffset<S> offset_;        // on top of its speed
  std::array<DriveEvent<S>, 2> events_{};
  SaturationCounter saturations_;
};

}  // namespace stiction
