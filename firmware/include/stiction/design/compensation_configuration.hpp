// From friction compensation in SI units to the configuration of the drive's stage. The one place where this is
// computed: machine files come here too. Laws: docs/friction_compensation.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "stiction/design/axis_parameters.hpp"
#include "stiction/design/compensation_parameters.hpp"
#include "stiction/design/conversion.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::design {

// Node speeds (m/s) of the drive's sliding table.
constexpr std::array<double, FixedSignals::speed_nodes> sliding_node_speeds() {
  std::array<double, FixedSignals::speed_nodes> speeds{};
  double octave = power_of_two(FixedSignals::lowest_speed_bit - FixedSignals::Velocity::fraction_bits);
  for (std::size_t k = 1; k < speeds.size(); octave *= 2.0) {
    speeds[k++] = octave;
    if (k < speeds.size()) speeds[k++] = 1.5 * octave;
  }
  return speeds;
}

// A (speed, value) list, increasing in speed, read at `speed`: from zero at rest by straight lines, beyond its end by
// the last one's slope. `speeds` in m/s; `values` in the unit of the result, one for each.
constexpr double sliding_value(std::span<const double> speeds, std::span<const double> values, double speed) {
  double v0 = 0.0, f0 = 0.0, slope = 0.0;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    slope = (values[k] - f0) / (speeds[k] - v0);
    if (speed <= speeds[k]) return f0 + slope * (speed - v0);
    v0 = speeds[k];
    f0 = values[k];
  }
  return f0 + slope * (speed - v0);
}

// Ticks of `period` s nearest to `time`, s.
constexpr std::uint32_t whole_ticks(double time, double period) {
  return static_cast<std::uint32_t>(nearest(time / period));
}

// `p`: the parameters; `period`: s, of the fast tick; `convert`: takes the problems.
template <class S>
constexpr typename ReversalPulse<S>::Config configure_pulse(const PulseCompensationParameters& p, double period,
                                                            const Converter& convert) {
  typename ReversalPulse<S>::Config c;
  c.amplitude = convert.template operator()<typename S::Velocity>(p.amplitude,
                                                                  {"friction_compensation.pulse.amplitude", "", "m/s"});
  c.final_amplitude = convert.template operator()<typename S::Velocity>(
      p.final_amplitude, {"friction_compensation.pulse.final_amplitude", "", "m/s"});
  c.rise = convert.template operator()<typename S::PulseSlope>(
      p.amplitude / p.rise_until, {"friction_compensation.pulse.rise_until", "amplitude / rise_until", "s"});
  c.fall = convert.template operator()<typename S::PulseSlope>(
      (p.amplitude - p.final_amplitude) / (p.fall_until - p.flat_until),
      {"friction_compensation.pulse.fall_until", "slope of the fall", "s"});
  c.flat_until = convert.template operator()<typename S::Acceleration>(
      p.flat_until, {"friction_compensation.pulse.flat_until", "", "m/s^2"});
  c.delay_ticks = whole_ticks(p.delay, period);
  const std::uint32_t duration = whole_ticks(p.duration, period);
  c.duration_ticks = duration == 0 ? 1 : duration;
  return c;
}

// Of the whole current, what it may be above the levels and the sliding curve: damping of the contact comes on top.
inline constexpr double damping_margin = 1.3;

// `f`: the parameters; `axis`: the design of the axis; `current_limit`: of the whole axis, A; `convert`: takes the
// problems.
template <class S, class Design>
constexpr typename stiction::FrictionFeedforward<S>::Config configure_friction(const FrictionFeedforwardParameters& f,
                                                                               const Design& axis, double current_limit,
                                                                               const Converter& convert) {
  using Current = typename S::Current;
  const char* ampere = axis.motor.loop == CurrentLoop::none ? "V" : "A";
  const Quantity level{"friction_compensation.friction.level", "", ampere};
  const auto held = [&](double current) {
    const double below = current_limit < current ? current_limit : current;
    return below < -current_limit ? -current_limit : below;
  };
  const auto magnitude = [](double x) { return x < 0.0 ? -x : x; };
  const auto larger = [](double a, double b) { return a < b ? b : a; };
  typename stiction::FrictionFeedforward<S>::Config c;
  double coulomb = 0.0, beyond = 0.0;
  for (std::size_t k = 0; k < f.distance.size(); ++k) {
    const double reach = 0.5 * f.distance[k];  // from the one end to the other
    c.elements[k].reach = convert.template operator()<typename S::Step>(
        reach, {"friction_compensation.friction.distance", "half of it", "m"});
    c.elements[k].stiffness = convert.template operator()<typename S::ContactStiffness>(
        f.level[k] / reach, {level.key, "level / half of the distance", "A/m"});
    coulomb += f.level[k];
  }
  c.damping = convert.template operator()<typename S::ContactDamping>(
      f.contact_damping / axis.timing.fast_period,
      {"friction_compensation.friction.contact_damping", "contact_damping / fast_period", ""});
  const auto speeds = sliding_node_speeds();
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    // Beyond what the axis can do the curve stays.
    const double fastest = 2.0 * axis.max_velocity;
    const double speed = fastest < speeds[k] ? fastest : speeds[k];
    const double forward = sliding_value(f.speed, f.forward, speed);
    const double backward = sliding_value(f.speed, f.backward, speed);
    c.forward[k] =
        convert.template operator()<Current>(held(forward), {"friction_compensation.friction.forward", "", ampere});
    c.backward[k] =
        convert.template operator()<Current>(held(backward), {"friction_compensation.friction.backward", "", ampere});
    beyond = larger(beyond, larger(magnitude(forward), magnitude(backward)));
  }
  const double whole = damping_margin * coulomb + beyond;
  c.limit = convert.template operator()<Current>(whole < current_limit ? whole : current_limit, level);
  return c;
}

// From a force to the error that it makes, s: the lag of the velocity loop, less what the lowpass of learning adds.
// `axis`: an AxisDesign; `learning`: its filter, and its own lead where that is not below 0.
template <class Design>
constexpr double learning_lead(const Design& axis, const QuadrantLearningParameters& learning) {
  if (learning.lead >= 0.0) return learning.lead;
  const double lag = axis.mass / (axis.velocity_controller.gain * axis.motor.force_constant);
  return lag > learning.filter ? lag - learning.filter : 0.0;
}

// Errors beyond this teach no more: where they come from is not friction.
inline constexpr double teaching_error = 50e-6;  // m

// `currents`: A at the nodes over the way since a reversal; `quantity`: their name and unit; `convert`: takes the
// problems.
template <class S>
constexpr typename stiction::QuadrantLearning<S>::Table learned_table(std::span<const double> currents,
                                                                      const Quantity& quantity,
                                                                      const Converter& convert) {
  typename stiction::QuadrantLearning<S>::Table table{};
  for (std::size_t k = 0; k < table.size() && k < currents.size(); ++k)
    table[k] = convert.template operator()<typename S::Current>(currents[k], quantity);
  return table;
}

// The missing current from the error of a PI velocity loop under a P position loop, k (e' + (K_v + 1/T_N) e), the first
// two terms of the loop's inverse; what is left of it, mass and a slow integral, is the lead. `learning`: the
// parameters; `axis`: an AxisDesign; `set_point_delay`: in ticks; `convert`: takes the problems.
template <class S, class Design>
constexpr typename stiction::QuadrantLearning<S>::Config configure_learning(const QuadrantLearningParameters& learning,
                                                                            const Design& axis,
                                                                            std::uint32_t set_point_delay,
                                                                            const Converter& convert) {
  using Weight = typename S::FilterCoefficient;
  using Gain = typename S::ContactStiffness;
  using Distance = typename S::Distance;
  const char* ampere = axis.motor.loop == CurrentLoop::none ? "V" : "A";
  const double period = axis.timing.fast_period, gain = axis.velocity_controller.gain;
  const double integral_time = axis.velocity_controller.integral_time;
  const double per_metre = gain * (axis.position_controller.gain + (integral_time == 0.0 ? 0.0 : 1.0 / integral_time));
  const double newest = 1.0 - __builtin_exp(-period / learning.filter);
  const Quantity filter{"friction_compensation.learning.filter", "share of the newest value", ""};
  const Quantity forgetting{"friction_compensation.learning.forgetting", "1 - forgetting - 2 smoothing", ""};
  typename stiction::QuadrantLearning<S>::Config c;
  c.rate_gain = convert.template operator()<Gain>(
      gain / period, {"friction_compensation.learning", "velocity gain / fast_period", "A/m"});
  c.error_gain = convert.template operator()<Gain>(
      per_metre, {"friction_compensation.learning", "velocity gain * (position gain + 1 / integral time)", "A/m"});
  c.dead_zone =
      convert.template operator()<Distance>(learning.dead_zone, {"friction_compensation.learning.dead_zone", "", "m"});
  c.error_limit =
      convert.template operator()<Distance>(teaching_error, {"friction_compensation.learning", "error limit", "m"});
  c.filter = convert.template operator()<Weight>(newest, filter);
  c.filter_rest = convert.template operator()<Weight>(1.0 - newest, filter);
  c.gain = convert.template operator()<Weight>(learning.gain, {"friction_compensation.learning.gain", "", ""});
  c.keep = convert.template operator()<Weight>(1.0 - learning.forgetting - 2.0 * learning.smoothing, forgetting);
  c.smoothing =
      convert.template operator()<Weight>(learning.smoothing, {"friction_compensation.learning.smoothing", "", ""});
  c.limit = convert.template operator()<typename S::Current>(learning.limit,
                                                             {"friction_compensation.learning.limit", "", ampere});
  const double lead = learning_lead(axis, learning);
  c.credit_ticks = set_point_delay + whole_ticks(lead, period);
  constexpr auto most = stiction::QuadrantLearning<S>::credit_buffer - 1;
  if (c.credit_ticks > most)
    convert.refuse({{"friction_compensation.learning.lead", "", "s"},
                    lead,
                    "with set_point_delay at most",
                    most * period,
                    ", what the drive's buffer of credits holds"});
  // An error within one increment of the position controller is none.
  const double increment = axis.position_controller.increment;
  c.tolerance = convert.template operator()<Distance>(increment < 0.5e-6 ? 0.5e-6 : increment,
                                                      {"friction_compensation.learning", "tolerance", "m"});
  c.machine = learning.identity;
  c.tables_machine = learning.learned_identity;
  c.tables = {
      learned_table<S>(learning.learned_backward, {"friction_compensation.learned.backward", "", ampere}, convert),
      learned_table<S>(learning.learned_forward, {"friction_compensation.learned.forward", "", ampere}, convert)};
  return c;
}

// `axis`: an AxisDesign; `design`: a CompensationDesign; `problems`: takes what the formats do not hold.
template <class S, class Design, class Compensation>
constexpr FrictionCompensationConfig<S> configure_compensation(const Design& axis, const Compensation& design,
                                                               Problems& problems) {
  const Converter convert(problems);
  const double period = axis.timing.fast_period;
  FrictionCompensationConfig<S> c;
  c.set_point_delay = whole_ticks(design.set_point_delay, period);
  c.kind = design.kind;
  if (design.pulse.duration > 0.0) c.pulse = configure_pulse<S>(design.pulse, period, convert);
  if (design.friction.given()) {
    c.friction = configure_friction<S>(design.friction, axis, largest_current(axis.motor, axis.inverter), convert);
    const double waits = c.set_point_delay - design.friction.look_ahead / period;
    const double lag = waits > 0.0 ? waits : 0.0;
    constexpr auto most = FrictionCompensationConfig<S>::buffer_ticks - 2;
    c.lag_ticks = static_cast<std::uint32_t>(lag) < most ? static_cast<std::uint32_t>(lag) : most;
    c.lag_fraction = convert.template operator()<typename S::TickFraction>(
        lag - c.lag_ticks, {"friction_compensation.friction.look_ahead", "set_point_delay - look_ahead", "ticks"});
  }
  if (design.learning.filter > 0.0)
    c.learning = configure_learning<S>(design.learning, axis, c.set_point_delay, convert);
  return c;
}

}  // namespace stiction::design
