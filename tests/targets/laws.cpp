#include "tests/targets/laws.hpp"

// Names without decoration, so that a profiler's options can name them.
#define STICTION_LAW(name)                                                                 \
  static void name##_of(stiction::targets::LawContext& c);                                 \
  extern "C" [[gnu::noinline]] void name(void* data);                                      \
  void name(void* data) { name##_of(*static_cast<stiction::targets::LawContext*>(data)); } \
  [[gnu::always_inline]] static inline void name##_of(stiction::targets::LawContext& c)

using S = stiction::FixedSignals;

// What is left of a count is a call and its return.
STICTION_LAW(law_nothing) { static_cast<void>(c); }

STICTION_LAW(law_axis) { c.command = c.axis.tick(c.set, c.feedback, c.now_ns, c.slow, c.signals); }

STICTION_LAW(law_cascade) { c.command = c.cascade.tick(c.set, c.feedback, c.now_ns, c.slow, c.other_signals); }

STICTION_LAW(law_cascade_given) { c.command = c.given.tick(c.set, c.feedback, c.now_ns, c.slow, c.other_signals); }

STICTION_LAW(law_estimate) {
  c.estimate =
      stiction::VelocityEstimator<S>::estimate(c.state.estimator, c.config.velocity_feedback, c.feedback.position,
                                               c.feedback.position_time_ns, c.feedback.velocity, c.state.saturations);
  stiction::VelocityEstimator<S>::push(c.state.estimator, c.feedback.position, c.feedback.position_time_ns);
}

STICTION_LAW(law_quantizer) {
  c.e_held = stiction::Quantizer<S>::apply(c.config.quantizer, c.signals.e, c.state.saturations);
}

STICTION_LAW(law_delay) {
  stiction::SpeedDelay<S>::push(c.state.set_speeds, c.set.velocity);
  c.v_set_delayed = stiction::SpeedDelay<S>::read(
      c.state.set_speeds, S::ticks(c.now_ns - c.state.velocity.time_ns, c.config.inverse_period), c.state.saturations);
}

STICTION_LAW(law_p_feedforward) {
  c.v_ref = stiction::narrow<S::Velocity>(
      c.config.position_gain * c.signals.e_held + c.config.velocity_feedforward * c.signals.v_set_delayed,
      c.state.saturations);
  c.i_feedforward =
      stiction::narrow<S::Current>(c.config.current_feedforward * c.set.acceleration, c.state.saturations);
}

STICTION_LAW(law_velocity_pi) {
  auto& pi = c.state.velocity_pi;
  const auto wanted = stiction::VelocityPi<S>::step(c.config.velocity, pi, c.signals.v_error, c.state.saturations);
  c.i_pi = wanted.output;
  stiction::VelocityPi<S>::track(c.config.velocity, pi, wanted.beyond_format, c.i_wanted, c.signals.i_set,
                                 c.state.saturations);
}

STICTION_LAW(law_notch) {
  c.i_notch = stiction::Notch<S>::step(c.config.notch, c.state.notch, c.signals.i_pi, c.state.saturations);
}

// From following error and set-point to current, without any limit: P, both feedforwards, PI, notch.
STICTION_LAW(law_p_ff_pi_notch) {
  auto& saturations = c.state.saturations;
  const auto v_ref = stiction::narrow<S::Velocity>(
      c.config.position_gain * c.signals.e_held + c.config.velocity_feedforward * c.signals.v_set_delayed, saturations);
  const auto v_error = stiction::saturated_difference(v_ref, c.signals.v, saturations);
  const auto i_pi = stiction::VelocityPi<S>::step(c.config.velocity, c.state.velocity_pi, v_error, saturations);
  const auto i_notch = stiction::Notch<S>::step(c.config.notch, c.state.notch, i_pi.output, saturations);
  const auto i_feedforward =
      stiction::narrow<S::Current>(c.config.current_feedforward * c.set.acceleration, saturations);
  c.i_unlimited = stiction::saturated_sum(i_notch, i_feedforward, saturations);
}

// The same with both limits, anti-windup, the watch over limit cycles, and every fault's threshold: the axis' own code.
STICTION_LAW(law_velocity_loop) {
  c.part.control_velocity(c.set, c.now_ns, c.part_signals);
  c.part.supervise(c.feedback, c.part_signals, c.now_ns);
}

STICTION_LAW(law_commutation) {
  using Commutation = stiction::Commutation<S>;
  auto& saturations = c.state.saturations;
  c.phase = Commutation::phases(S::angle(c.signals.x, c.config.inverse_pole_pair_pitch));
  c.amplitude = Commutation::amplitude(c.signals.i_phase, c.phase, saturations);
  c.i_set_phase = Commutation::phase_currents(c.signals.i_set, c.phase, saturations);
}

// Of one phase, with the limit of its voltage.
STICTION_LAW(law_current_pi) {
  auto& pi = c.state.current_pi[0];
  auto& saturations = c.state.saturations;
  const auto error = stiction::saturated_difference(c.i_set_phase[0], c.signals.i_phase[0], saturations);
  const auto wanted = stiction::CurrentPi<S>::step(c.config.current, pi, error, saturations);
  c.voltage = stiction::limit(wanted.output, c.config.voltage_limit);
  stiction::CurrentPi<S>::track(c.config.current, pi, wanted.beyond_format, wanted.output, c.voltage.value,
                                saturations);
}

// What the friction compensation adds to a tick: the delayed set-point with all that it puts on it, and what it takes
// from the axis' signals.
STICTION_LAW(law_pulse) { c.pulse.step(c.set_of_pulse, c.compensation_signals); }

STICTION_LAW(law_friction) { c.friction.step(c.set_of_friction, c.compensation_signals); }

STICTION_LAW(law_learning) {
  c.learning.step(c.set_of_learning, c.compensation_signals);
  c.learning.observe(c.signals, c.compensation_signals);
}

namespace stiction::targets {

#define STICTION_ROW(name) \
  Law { #name, name }
const std::array<Law, laws.size()> laws{
    {STICTION_ROW(law_nothing), STICTION_ROW(law_axis), STICTION_ROW(law_cascade), STICTION_ROW(law_cascade_given),
     STICTION_ROW(law_p_ff_pi_notch), STICTION_ROW(law_velocity_loop), STICTION_ROW(law_estimate),
     STICTION_ROW(law_quantizer), STICTION_ROW(law_delay), STICTION_ROW(law_p_feedforward),
     STICTION_ROW(law_velocity_pi), STICTION_ROW(law_notch), STICTION_ROW(law_commutation),
     STICTION_ROW(law_current_pi), STICTION_ROW(law_pulse), STICTION_ROW(law_friction), STICTION_ROW(law_learning)}};
#undef STICTION_ROW

}  // namespace stiction::targets
