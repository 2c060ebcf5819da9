// The cascade of one servo axis (Mendricky 2006, 3.2): P position controller on the slow tick; velocity feedforward,
// velocity estimate, PI velocity controller, notch, current feedforward, PI current controllers on the fast tick; all
// from samples of the same instant. Written once over a policy of signal types: Axis<FixedSignals> is the firmware.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/commutation.hpp"
#include "stiction/control/limit.hpp"
#include "stiction/control/limit_cycle.hpp"
#include "stiction/control/notch.hpp"
#include "stiction/control/pi.hpp"
#include "stiction/control/quantizer.hpp"
#include "stiction/control/velocity_estimator.hpp"
#include "stiction/drive/axis_signals.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/number/choice.hpp"
#include "stiction/number/fixed.hpp"
#include "stiction/number/trigonometry.hpp"

namespace stiction {

// What stands behind the velocity controller.
enum class CurrentLoop : std::uint8_t {
  three_phase,  // one PI per phase, commutated by the encoder's position
  direct,       // one PI: DC motor
  none,         // the velocity controller's output is the voltage command of a force source, 1 A standing for 1 V
  three_phase_offset,  // as three_phase, from an electrical angle at the encoder's zero, or at an angle that is given
};

template <class S>
using VelocityPi =
    Pi<PiTypes<typename S::Velocity, typename S::Current, typename S::VelocityGain, typename S::VelocityIntegralGain,
               typename S::VelocityIntegral, typename S::VelocityTracking>>;
template <class S>
using CurrentPi =
    Pi<PiTypes<typename S::Current, typename S::Voltage, typename S::CurrentGain, typename S::CurrentIntegralGain,
               typename S::CurrentIntegral, typename S::CurrentTracking>>;

template <class S>
struct AxisConfig {
  std::int64_t period_ns = 0;  // of the fast tick
  typename S::PeriodInverse inverse_period{};
  typename Quantizer<S>::Config quantizer{};
  typename S::PositionGain position_gain{};
  typename S::VelocityWeight velocity_feedforward{};
  VelocityFeedback velocity_feedback = VelocityFeedback::difference;
  typename VelocityPi<S>::Config velocity{};
  typename Notch<S>::Config notch{};
  typename S::AccelerationGain current_feedforward{};
  CurrentLoop current_loop = CurrentLoop::three_phase;
  typename CurrentPi<S>::Config current{};
  typename S::PitchInverse inverse_pole_pair_pitch{};

  // Limits hold an output back; faults stop the axis.
  typename S::Velocity velocity_limit{};
  typename S::Current current_limit{};
  typename S::Voltage voltage_limit{};
  typename S::Distance following_error_fault{};
  typename S::Current over_current_fault{};
  typename S::Velocity over_speed_fault{};
  std::uint32_t limit_cycle_window_ticks = 0;
};

template <class S>
struct AxisState {
  Each<S, bool> running{};
  Each<S, Fault> fault{};
  Each<S, std::int64_t> fault_time_ns{};
  Each<S, std::uint8_t> missed_positions{};
  typename S::Distance e_held{};
  typename VelocityEstimator<S>::State estimator{};
  typename VelocityEstimator<S>::Estimate velocity{};
  typename SpeedDelay<S>::State set_speeds{};
  typename VelocityPi<S>::State velocity_pi{};
  typename Notch<S>::State notch{};
  std::array<typename CurrentPi<S>::State, 3> current_pi{};
  std::int32_t cycle_ticks_left = 0;  // of the window of both limit cycles
  typename LimitCycle<S>::State current_cycle{};
  typename LimitCycle<S>::State
      voltage_cycle{};  // of the first phase: an unstable current loop oscillates in every phase
  SaturationCounter saturations{};
};

// Results of several parts are not const in here: GCC 12 keeps a const aggregate together as one word and takes it
// apart with masks, 30 instructions a tick on Cortex-M4.
template <class S>
class Axis {
 public:
  static constexpr int missed_positions_allowed = 2;

  explicit constexpr Axis(const AxisConfig<S>& config) : config_(config) {}

  constexpr const AxisConfig<S>& config() const { return config_; }
  constexpr const AxisState<S>& state() const { return state_; }
  constexpr Each<S, Fault> fault() const { return state_.fault; }
  constexpr Each<S, std::int64_t> fault_time_ns() const { return state_.fault_time_ns; }

  // Starts control at rest at the measured position and clears a fault. Call before the first tick.
  constexpr void start(const Feedback<S>& feedback) {
    state_ = {};
    state_.running = Each<S, bool>{true};
    state_.estimator = VelocityEstimator<S>::start(feedback.position, feedback.position_time_ns, config_.period_ns);
    state_.velocity = {{}, feedback.position_time_ns};
  }

  // Takes the power off without a fault; the velocity is still estimated. start() begins again.
  constexpr void stop() { state_.running = {}; }

  // Latches a fault that was seen outside of the axis, such as a set-point that could not be represented.
  constexpr void trip(Fault fault, std::int64_t now_ns) requires OneAxis<S> {
    if (state_.fault != Fault::none) return;
    state_.fault = fault;
    state_.fault_time_ns = now_ns;
    state_.running = false;
  }

  // Of CurrentLoop::three_phase_offset: the electrical angle where the encoder shows zero. Kept over start(). `offset`:
  // from now on.
  constexpr void commutate(Turn offset) {
    commutation_ = offset;
    vector_given_ = false;
  }
  // Of the same, in place of what the position gives: the current's vector. `angle`: from now on.
  constexpr void give_vector(Turn angle) {
    vector_ = angle;
    vector_given_ = true;
  }
  constexpr Turn commutation() const { return commutation_; }

  // One fast tick at logical time `now_ns`; `slow` on the ticks of the position controller. Writes every signal of
  // the cascade to `s`. `set`: set-point of this tick; `feedback`: newest position, currents and fault inputs. Returns
  // voltages and enable, which is off after a fault.
  constexpr Command<S> tick(const SetPoint<S>& set, const Feedback<S>& feedback, std::int64_t now_ns, bool slow,
                            AxisSignals<S>& s) {
    auto& saturations = state_.saturations;
    take_feedback(feedback, now_ns);

    s.x_set = set.position;
    s.v_set = set.velocity;
    s.a_set = set.acceleration;
    s.x = state_.estimator.x1;
    s.v = state_.velocity.velocity;

    // Position: the set-point is taken back to the time of the sample.
    const auto age = S::seconds(now_ns - state_.estimator.t1_ns);
    const auto since = narrow<typename S::Position>(set.velocity * age, saturations);
    s.e = narrow<typename S::Distance>(set.position - since - s.x, saturations);
    if (slow) state_.e_held = Quantizer<S>::apply(config_.quantizer, s.e, saturations);
    s.e_held = state_.e_held;

    // The set speed is read at the time for which the measured one holds.
    SpeedDelay<S>::push(state_.set_speeds, set.velocity);
    s.v_set_delayed = SpeedDelay<S>::read(
        state_.set_speeds, S::ticks(now_ns - state_.velocity.time_ns, config_.inverse_period), saturations);
    if (set.by_current || set.limits_current) [[unlikely]]
      control_to_order(set, now_ns, s);
    else
      control_velocity(set, now_ns, s);

    Command<S> command;
    s.i_integral = state_.velocity_pi.integral;
    s.i_phase = feedback.current;
    s.limiting.voltage = {};
    Each<S, int> voltage_side{};
    switch (config_.current_loop) {
      case CurrentLoop::three_phase:
        voltage_side = control_phases(s, command);
        break;
      case CurrentLoop::direct:
        voltage_side = control_direct(s, command);
        break;
      case CurrentLoop::none:
        voltage_side = pass_through(s, command);
        break;
      case CurrentLoop::three_phase_offset:
        voltage_side = control_offset_phases(s, command);
        break;
    }
    watch_cycle(state_.voltage_cycle, voltage_side, now_ns);

    trip_where(!set.valid, Fault::set_point, now_ns);
    supervise(feedback, s, now_ns);
    s.fault = state_.fault;
    if (!all(state_.running))
      for (auto& u : command.voltage) assign(!state_.running, u, Voltage{});
    command.enable = state_.running;
    s.u_phase = command.voltage;
    return command;
  }

  // Parts of a tick, public so that their work can be counted.

  // P, velocity feedforward, PI, notch, current feedforward, with both limits, anti-windup and the watch over limit
  // cycles: from e_held, v_set_delayed and v to i_set. `set`: set-point of this tick; `now_ns`: its time; `s`: signals
  // of the tick, read and written.
  [[gnu::always_inline]] constexpr void control_velocity(const SetPoint<S>& set, std::int64_t now_ns,
                                                         AxisSignals<S>& s) {
    cascade<false>(set, now_ns, s);
  }

  // Every threshold that stops the axis. `feedback`: of this tick; `s`: its signals; `now_ns`: its time. Latches the
  // first fault.
  [[gnu::always_inline]] constexpr void supervise(const Feedback<S>& feedback, const AxisSignals<S>& s,
                                                  std::int64_t now_ns) {
    trip_where(feedback.fault, Fault::drive_input, now_ns);
    const auto most = config_.over_current_fault;
    trip_where(
        exceeds(s.i, most) || exceeds(s.i_phase[0], most) || exceeds(s.i_phase[1], most) || exceeds(s.i_phase[2], most),
        Fault::over_current, now_ns);
    trip_where(exceeds(s.v, config_.over_speed_fault), Fault::over_speed, now_ns);
    trip_where(exceeds(s.e, config_.following_error_fault), Fault::following_error, now_ns);
  }

 private:
  using Current = typename S::Current;
  using Voltage = typename S::Voltage;

  // Latches the fault where the `condition` holds and none is latched yet.
  [[gnu::always_inline]] constexpr void trip_where(Each<S, bool> condition, Fault fault, std::int64_t now_ns) {
    if constexpr (OneAxis<S>) {
      if (condition) trip(fault, now_ns);
    } else if (any(condition)) {
      const auto first = condition && state_.fault == Fault::none;
      assign(first, state_.fault, Each<S, Fault>{fault});
      assign(first, state_.fault_time_ns, Each<S, std::int64_t>{now_ns});
      assign(first, state_.running, Each<S, bool>{});
    }
  }

  // The same where the set-point orders the current itself or its limit. A function of its own: nearly every tick does
  // without, and what it takes is not in theirs.
  [[gnu::noinline]] constexpr void control_to_order(const SetPoint<S>& set, std::int64_t now_ns, AxisSignals<S>& s) {
    cascade<true>(set, now_ns, s);
  }

  template <bool ordered>
  [[gnu::always_inline]] constexpr void cascade(const SetPoint<S>& set, std::int64_t now_ns, AxisSignals<S>& s) {
    auto& saturations = state_.saturations;
    auto v_ref = limit_sum(config_.position_gain * s.e_held + config_.velocity_feedforward * s.v_set_delayed,
                           config_.velocity_limit);
    s.v_ref = v_ref.value;
    s.limiting.velocity = v_ref.limiting();
    s.v_error = saturated_difference(s.v_ref, s.v, saturations);
    auto pi = VelocityPi<S>::step(config_.velocity, state_.velocity_pi, s.v_error, saturations);
    s.i_pi = pi.output;
    s.i_notch = Notch<S>::step(config_.notch, state_.notch, s.i_pi, saturations);
    s.i_feedforward = narrow<typename S::Current>(config_.current_feedforward * set.acceleration, saturations);
    const auto i_added = saturated_sum(s.i_feedforward, set.injection, saturations);
    const auto i_wanted = saturated_sum(s.i_notch, i_added, saturations);
    // A current that is given is one more limit of the cascade's: the integrator follows it and takes over from it.
    const bool given = ordered && set.by_current, limited = ordered && set.limits_current;
    auto i_set = limit(given ? set.injection : i_wanted, limited ? set.most_current : config_.current_limit);
    s.i_set = i_set.value;
    s.limiting.current = i_set.limiting();
    VelocityPi<S>::track(config_.velocity, state_.velocity_pi, pi.beyond_format, i_wanted, i_set.value, saturations);
    LimitCycle<S>::advance_window(state_.cycle_ticks_left, config_.limit_cycle_window_ticks, state_.current_cycle,
                                  state_.voltage_cycle);
    watch_cycle(state_.current_cycle, i_set.side, now_ns);
  }

  constexpr void watch_cycle(typename LimitCycle<S>::State& cycle, Each<S, int> side, std::int64_t now_ns) {
    trip_where(LimitCycle<S>::step(cycle, side), Fault::limit_cycle, now_ns);
  }
  // A sample that is not valid leaves position and velocity as they were; too many in a row are a fault.
  constexpr void take_feedback(const Feedback<S>& feedback, std::int64_t now_ns) {
    // A sample that came before is as good as none, and a stamp from the future is no stamp.
    const auto fresh = feedback.position_valid && feedback.position_time_ns > state_.estimator.t1_ns &&
                       feedback.position_time_ns <= now_ns + config_.period_ns;
    // A tick without one takes the same work: an estimate as of standstill, which is dropped.
    const auto x = select(fresh, feedback.position, state_.estimator.x1);
    const auto t_ns = select(fresh, feedback.position_time_ns, state_.estimator.t1_ns + config_.period_ns);
    auto velocity = VelocityEstimator<S>::estimate(state_.estimator, config_.velocity_feedback, x, t_ns,
                                                   feedback.velocity, state_.saturations);
    if (!all(fresh)) {
      if constexpr (OneAxis<S>) {
        if (++state_.missed_positions > missed_positions_allowed) trip(Fault::position_lost, now_ns);
        return;
      } else {
        return take_some(fresh, velocity, x, t_ns, now_ns);
      }
    }
    state_.missed_positions = {};
    state_.velocity = velocity;
    VelocityEstimator<S>::push(state_.estimator, x, t_ns);
  }

  // Of a batch in which a sample of some axes is not `fresh`: what one axis does, lane by lane.
  [[gnu::noinline]] constexpr void take_some(Each<S, bool> fresh,
                                             const typename VelocityEstimator<S>::Estimate& velocity,
                                             typename S::Position x, Each<S, std::int64_t> t_ns,
                                             std::int64_t now_ns) requires(!OneAxis<S>) {
    state_.missed_positions =
        select(fresh, Each<S, std::uint8_t>{}, static_cast<Each<S, std::uint8_t>>(state_.missed_positions + 1));
    trip_where(state_.missed_positions > missed_positions_allowed, Fault::position_lost, now_ns);
    assign(fresh, state_.velocity.velocity, velocity.velocity);
    assign(fresh, state_.velocity.time_ns, velocity.time_ns);
    auto pushed = state_.estimator;
    VelocityEstimator<S>::push(pushed, x, t_ns);
    assign(fresh, state_.estimator.x1, pushed.x1);
    assign(fresh, state_.estimator.x2, pushed.x2);
    assign(fresh, state_.estimator.t1_ns, pushed.t1_ns);
    assign(fresh, state_.estimator.t2_ns, pushed.t2_ns);
  }

  // Inline by order: a call costs as much as a third of it.
  [[gnu::always_inline]] constexpr Limited<Voltage> control_current(std::size_t phase, Current set, Current measured,
                                                                    AxisSignals<S>& s) {
    auto& saturations = state_.saturations;
    auto& pi = state_.current_pi[phase];
    auto wanted =
        CurrentPi<S>::step(config_.current, pi, saturated_difference(set, measured, saturations), saturations);
    auto u = limit(wanted.output, config_.voltage_limit);
    CurrentPi<S>::track(config_.current, pi, wanted.beyond_format, wanted.output, u.value, saturations);
    s.limiting.voltage |= u.limiting();
    return u;
  }

  // These give the voltages and return the side of the limit that holds the first one back.

  // The side is that of the amplitude: a healthy limited phase changes side with its sine, twice an electrical turn.
  constexpr Each<S, int> control_phases(AxisSignals<S>& s, Command<S>& command) {
    return control_phases_at(S::angle(s.x, config_.inverse_pole_pair_pitch), s, command);
  }
  // A function of its own: an axis whose encoder's zero is the motor's has nothing of it.
  [[gnu::noinline]] constexpr Each<S, int> control_offset_phases(AxisSignals<S>& s, Command<S>& command) {
    const auto angle = vector_given_ ? S::turned({}, vector_)
                                     : S::turned(S::angle(s.x, config_.inverse_pole_pair_pitch), commutation_);
    return control_phases_at(angle, s, command);
  }
  [[gnu::always_inline]] constexpr Each<S, int> control_phases_at(typename S::Angle angle, AxisSignals<S>& s,
                                                                  Command<S>& command) {
    auto& saturations = state_.saturations;
    const auto phase = Commutation<S>::phases(angle);
    s.i = Commutation<S>::amplitude(s.i_phase, phase, saturations);
    const auto set = Commutation<S>::phase_currents(s.i_set, phase, saturations);
    // Written out: a signal with a running index must be stored even where nobody reads it.
    auto a = control_current(0, set[0], s.i_phase[0], s);
    auto b = control_current(1, set[1], s.i_phase[1], s);
    auto c = control_current(2, set[2], s.i_phase[2], s);
    command.voltage = {a.value, b.value, c.value};
    return select(phase[0] < typename S::Sine{}, -a.side, a.side);
  }

  constexpr Each<S, int> control_direct(AxisSignals<S>& s, Command<S>& command) {
    s.i = s.i_phase[0];
    auto u = control_current(0, s.i_set, s.i, s);
    command.voltage[0] = u.value;
    return u.side;
  }

  constexpr Each<S, int> pass_through(AxisSignals<S>& s, Command<S>& command) {
    s.i = s.i_set;
    auto u = limit(narrow<Voltage>(s.i_set, state_.saturations), config_.voltage_limit);
    s.limiting.voltage = u.limiting();
    command.voltage[0] = u.value;
    return u.side;
  }

  AxisConfig<S> config_;
  AxisState<S> state_;
  Turn commutation_{}, vector_{};
  bool vector_given_ = false;
};

}  // namespace stiction
