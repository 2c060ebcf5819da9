#include "firmware/machine/configuration/compensation_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

// What the whole current may be above the levels and the sliding curve: damping of the contact comes on top of them.
constexpr double damping_margin = 1.3;

class Converter {
 public:
  explicit Converter(const std::string& axis) : axis_(axis) {}

  template <class T>
  T operator()(double value, const char* key) const {
    if (const auto signal = to_signal<T>(value)) return *signal;
    throw ConfigurationError(fmt::format(
        "axis.{}.friction_compensation.{}: found {:g}; expected at most {:g} in magnitude, the range of the "
        "drive's number format",
        axis_, key, value, highest<T>()));
  }

 private:
  const std::string& axis_;
};

std::uint32_t whole_ticks(double time, double period) { return static_cast<std::uint32_t>(std::lround(time / period)); }

template <class S>
typename ReversalPulse<S>::Config pulse_of(const PulseCompensationParameters& p, double period,
                                           const Converter& convert) {
  typename ReversalPulse<S>::Config c;
  c.amplitude = convert.template operator()<typename S::Velocity>(p.amplitude, "pulse.amplitude");
  c.final_amplitude = convert.template operator()<typename S::Velocity>(p.final_amplitude, "pulse.final_amplitude");
  c.rise = convert.template operator()<typename S::PulseSlope>(p.amplitude / p.rise_until, "pulse.rise_until");
  c.fall = convert.template operator()<typename S::PulseSlope>(
      (p.amplitude - p.final_amplitude) / (p.fall_until - p.flat_until), "pulse.fall_until");
  c.flat_until = convert.template operator()<typename S::Acceleration>(p.flat_until, "pulse.flat_until");
  c.delay_ticks = whole_ticks(p.delay, period);
  c.duration_ticks = std::max(1u, whole_ticks(p.duration, period));
  return c;
}

template <class S>
typename stiction::FrictionFeedforward<S>::Config friction_of(const FrictionFeedforwardParameters& f, double period,
                                                              double fastest, double current_limit,
                                                              const Converter& convert) {
  using Current = typename S::Current;
  typename stiction::FrictionFeedforward<S>::Config c;
  double coulomb = 0.0, beyond = 0.0;
  for (std::size_t k = 0; k < f.distance.size(); ++k) {
    const double reach = 0.5 * f.distance[k];  // from the one end to the other
    c.elements[k].reach = convert.template operator()<typename S::Step>(reach, "friction.distance");
    c.elements[k].stiffness =
        convert.template operator()<typename S::ContactStiffness>(f.level[k] / reach, "friction.level");
    coulomb += f.level[k];
  }
  c.damping =
      convert.template operator()<typename S::ContactDamping>(f.contact_damping / period, "friction.contact_damping");
  const auto speeds = sliding_node_speeds();
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    // Beyond what the axis can do the curve stays.
    const double speed = std::min(speeds[k], 2.0 * fastest);
    const double forward = sliding_value(f.speed, f.forward, speed);
    const double backward = sliding_value(f.speed, f.backward, speed);
    c.forward[k] =
        convert.template operator()<Current>(std::clamp(forward, -current_limit, current_limit), "friction.forward");
    c.backward[k] =
        convert.template operator()<Current>(std::clamp(backward, -current_limit, current_limit), "friction.backward");
    beyond = std::max({beyond, std::abs(forward), std::abs(backward)});
  }
  c.limit = convert.template operator()<Current>(std::min(current_limit, damping_margin * coulomb + beyond),
                                                 "friction.level");
  return c;
}

template <class S>
typename stiction::QuadrantLearning<S>::Table table_of(const std::vector<double>& currents, const char* key,
                                                       const Converter& convert) {
  typename stiction::QuadrantLearning<S>::Table table;
  for (std::size_t k = 0; k < std::min(table.size(), currents.size()); ++k)
    table[k] = convert.template operator()<typename S::Current>(currents[k], key);
  return table;
}

// Errors beyond this teach no more: where they come from is not friction.
constexpr double teaching_error = 50e-6;  // m

// The missing current from the error of a PI velocity loop under a P position loop, k (e' + (K_v + 1/T_N) e), the first
// two terms of the loop's inverse; what is left of it, mass and a slow integral, is the lead.
template <class S>
typename stiction::QuadrantLearning<S>::Config learning_of(const Machine& machine, const AxisModel& axis,
                                                           std::uint32_t set_point_delay, const Converter& convert) {
  using Weight = typename S::FilterCoefficient;
  using Gain = typename S::ContactStiffness;
  const auto& learning = *axis.friction_compensation->learning;
  const double period = machine.timing.fast_period, gain = axis.velocity_controller.gain;
  const auto& integral_time = axis.velocity_controller.integral_time;
  const double per_metre = gain * (axis.position_controller.gain + (integral_time ? 1.0 / *integral_time : 0.0));
  const double newest = 1.0 - std::exp(-period / learning.filter);
  typename stiction::QuadrantLearning<S>::Config c;
  c.rate_gain = convert.template operator()<Gain>(gain / period, "learning");
  c.error_gain = convert.template operator()<Gain>(per_metre, "learning");
  c.dead_zone = convert.template operator()<typename S::Distance>(learning.dead_zone, "learning.dead_zone");
  c.error_limit = convert.template operator()<typename S::Distance>(teaching_error, "learning");
  c.filter = convert.template operator()<Weight>(newest, "learning.filter");
  c.filter_rest = convert.template operator()<Weight>(1.0 - newest, "learning.filter");
  c.gain = convert.template operator()<Weight>(learning.gain, "learning.gain");
  c.keep =
      convert.template operator()<Weight>(1.0 - learning.forgetting - 2.0 * learning.smoothing, "learning.forgetting");
  c.smoothing = convert.template operator()<Weight>(learning.smoothing, "learning.smoothing");
  c.limit = convert.template operator()<typename S::Current>(learning.limit, "learning.limit");
  c.credit_ticks = set_point_delay + whole_ticks(learning_lead(axis), period);
  constexpr auto most = stiction::QuadrantLearning<S>::credit_buffer - 1;
  if (c.credit_ticks > most)
    throw ConfigurationError(
        fmt::format("axis.{}.friction_compensation.learning.lead: found {:g} ms, with set_point_delay {} ticks of "
                    "fast_period; expected at most {}, what the drive's buffer of credits holds",
                    axis.name, learning_lead(axis) * 1e3, c.credit_ticks, most));
  // An error within one increment of the position controller is none.
  c.tolerance = convert.template operator()<typename S::Distance>(std::max(axis.position_controller.increment, 0.5e-6),
                                                                  "learning");
  c.machine = learning_identity(machine.name, axis.name);
  c.tables_machine = c.machine;
  if (const auto& learned = axis.friction_compensation->learned) {
    c.tables_machine = learning_identity(learned->machine, learned->axis);
    c.tables = {table_of<S>(learned->backward, "learned.backward", convert),
                table_of<S>(learned->forward, "learned.forward", convert)};
  }
  return c;
}

}  // namespace

std::uint32_t learning_identity(std::string_view machine, std::string_view axis) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  const auto add = [&](unsigned char c) { hash = (hash ^ c) * 16777619u; };
  for (const char c : machine) add(static_cast<unsigned char>(c));
  add(0);
  for (const char c : axis) add(static_cast<unsigned char>(c));
  return hash | 1u;
}

double learning_lead(const AxisModel& axis) {
  const auto& learning = *axis.friction_compensation->learning;
  const double lag = axis.mass / (axis.velocity_controller.gain * axis.motor.force_constant);
  return learning.lead.value_or(std::max(0.0, lag - learning.filter));
}

bool has_compensation(const Machine& machine) {
  return std::any_of(machine.axes.begin(), machine.axes.end(), [](const AxisModel& axis) {
    return axis.friction_compensation && axis.friction_compensation->use != CompensationKind::off;
  });
}

double set_point_delay(const Machine& machine) {
  return has_compensation(machine) ? machine.timing.set_point_delay : 0.0;
}

std::vector<double> sliding_node_speeds() {
  constexpr double first = power_of_two(FixedSignals::lowest_speed_bit - FixedSignals::Velocity::fraction_bits);
  std::vector<double> speeds{0.0};
  for (double octave = first; speeds.size() < FixedSignals::speed_nodes; octave *= 2.0) {
    speeds.push_back(octave);
    if (speeds.size() < FixedSignals::speed_nodes) speeds.push_back(1.5 * octave);
  }
  return speeds;
}

double sliding_value(const std::vector<double>& speeds, const std::vector<double>& values, double speed) {
  double v0 = 0.0, f0 = 0.0, slope = 0.0;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    slope = (values[k] - f0) / (speeds[k] - v0);
    if (speed <= speeds[k]) return f0 + slope * (speed - v0);
    v0 = speeds[k];
    f0 = values[k];
  }
  return f0 + slope * (speed - v0);
}

template <class S>
FrictionCompensationConfig<S> configure_compensation(const Machine& machine, const AxisModel& axis) {
  const Converter convert(axis.name);
  const Timing& timing = machine.timing;
  const double period = timing.fast_period;
  FrictionCompensationConfig<S> c;
  c.set_point_delay = whole_ticks(timing.set_point_delay, period);
  if (!axis.friction_compensation) return c;
  const auto& compensation = *axis.friction_compensation;
  c.kind = compensation.use;
  if (compensation.pulse) c.pulse = pulse_of<S>(*compensation.pulse, period, convert);
  if (compensation.friction) {
    const double limit = axis.motor.model == MotorModel::force ? axis.inverter.voltage_limit
                                                               : axis.inverter.current_limit * axis.motor.count;
    c.friction = friction_of<S>(*compensation.friction, period, axis.max_velocity, limit, convert);
    const double lag = std::max(0.0, c.set_point_delay - compensation.friction->look_ahead / period);
    c.lag_ticks = std::min(static_cast<std::uint32_t>(lag), FrictionCompensationConfig<S>::buffer_ticks - 2);
    c.lag_fraction = convert.template operator()<typename S::TickFraction>(lag - c.lag_ticks, "friction.look_ahead");
  }
  if (compensation.learning) c.learning = learning_of<S>(machine, axis, c.set_point_delay, convert);
  return c;
}

template <class S>
std::vector<FrictionCompensationConfig<S>> configure_compensations(const Machine& machine) {
  std::vector<FrictionCompensationConfig<S>> configs;
  if (!has_compensation(machine)) return configs;
  for (const auto& axis : machine.axes) configs.push_back(configure_compensation<S>(machine, axis));
  return configs;
}

template FrictionCompensationConfig<FixedSignals> configure_compensation<FixedSignals>(const Machine&,
                                                                                       const AxisModel&);
template FrictionCompensationConfig<DoubleSignals> configure_compensation<DoubleSignals>(const Machine&,
                                                                                         const AxisModel&);
template std::vector<FrictionCompensationConfig<FixedSignals>> configure_compensations<FixedSignals>(const Machine&);
template std::vector<FrictionCompensationConfig<DoubleSignals>> configure_compensations<DoubleSignals>(const Machine&);

}  // namespace stiction::machine
