#include "firmware/machine/configuration/axis_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

// Converts the parameters of one axis and names the key of the one that does not fit.
class Converter {
 public:
  explicit Converter(std::string axis) : axis_(std::move(axis)) {}

  template <class T>
  T operator()(double value, const char* key, const char* what) const {
    if (const auto signal = to_signal<T>(value)) return *signal;
    throw ConfigurationError(
        fmt::format("axis.{}.{}: found {} = {:g}; expected at most {:g} in magnitude, the range of "
                    "the drive's number format",
                    axis_, key, what, value, highest<T>()));
  }
  // A gain that would round to nothing is refused too: it would act as zero.
  template <class T>
  T gain(double value, const char* key, const char* what) const {
    const T signal = (*this)(static_cast<double>(value), key, what, T{});
    return signal;
  }

 private:
  template <class T>
  T operator()(double value, const char* key, const char* what, T) const {
    const T signal = (*this).template operator()<T>(value, key, what);
    if (value != 0.0 && std::abs(to_si(signal) / value - 1.0) > 0.01)
      throw ConfigurationError(
          fmt::format("axis.{}.{}: found {} = {:g}; expected a value that the drive's number format "
                      "resolves to 1 % (it would become {:g})",
                      axis_, key, what, value, to_si(signal)));
    return signal;
  }

  std::string axis_;
};

// Bilinear transform of (3.19) with the frequency prewarped, so that the notch sits exactly at its frequency.
struct Biquad {
  double b0, b1, b2, a1, a2;
};
Biquad discretise(const machine::NotchParameters& notch, double period) {
  const double w = std::tan(std::numbers::pi * notch.frequency * period);
  const double n = 2.0 * notch.numerator_damping * w;
  const double d = 2.0 * notch.denominator_damping * w;
  const double scale = 1.0 / (1.0 + d + w * w);
  return {(1.0 + n + w * w) * scale, 2.0 * (w * w - 1.0) * scale, (1.0 - n + w * w) * scale,
          2.0 * (w * w - 1.0) * scale, (1.0 - d + w * w) * scale};
}

VelocityFeedback feedback_of(VelocitySource source) {
  switch (source) {
    case VelocitySource::ideal:
      return VelocityFeedback::given;
    case VelocitySource::estimated:
      return VelocityFeedback::difference;
    case VelocitySource::mean_difference:
      return VelocityFeedback::mean_difference;
  }
  throw ConfigurationError("encoder.velocity: unknown source");
}

CurrentLoop loop_of(MotorModel model) {
  switch (model) {
    case MotorModel::synchronous:
      return CurrentLoop::three_phase;
    case MotorModel::dc:
      return CurrentLoop::direct;
    case MotorModel::force:
      return CurrentLoop::none;
  }
  throw ConfigurationError("motor.model: unknown model");
}

// Takes the integral part k T / T_N and, as tracking time, T_N itself: the excess behind a limit leaves the integrator
// as fast as an error entered it.
template <class Config>
void set_pi(Config& pi, const Converter& convert, double gain, const std::optional<double>& integral_time,
            double period, const char* gain_key, const char* time_key) {
  pi.proportional = convert.template gain<decltype(pi.proportional)>(gain, gain_key, "gain");
  if (!integral_time) return;
  pi.integral =
      convert.template gain<decltype(pi.integral)>(gain * period / *integral_time, time_key, "gain * period / time");
  pi.tracking = convert.template gain<decltype(pi.tracking)>(period / *integral_time, time_key, "period / time");
}

}  // namespace

std::int64_t fast_period_ns(const Timing& timing) { return std::llround(timing.fast_period * 1e9); }
int slow_ratio(const Timing& timing) { return static_cast<int>(std::lround(timing.slow_period / timing.fast_period)); }

template <class S>
AxisConfig<S> configure_axis(const Timing& timing, const AxisModel& axis) {
  const Converter convert(axis.name);
  const double period = timing.fast_period;
  AxisConfig<S> c;
  c.period_ns = fast_period_ns(timing);
  const auto inverse_period = to_signal<typename S::PeriodInverse>(1e-9 / period);
  if (!inverse_period)
    throw ConfigurationError(
        fmt::format("timing.fast_period: found {:g} us; expected at least {:.4g} us, the range of the "
                    "drive's number format",
                    period * 1e6, 1e-3 / highest<typename S::PeriodInverse>()));
  c.inverse_period = *inverse_period;
  if (axis.position_controller.increment > 0.0) {
    const double increment = axis.position_controller.increment;
    c.quantizer = {
        true,
        convert.template gain<typename S::IncrementInverse>(1.0 / increment, "position_controller.increment",
                                                            "1 / increment"),
        convert.template gain<typename S::Increment>(increment, "position_controller.increment", "increment")};
  }
  c.position_gain = convert.template gain<typename S::PositionGain>(axis.position_controller.gain,
                                                                    "position_controller.gain", "gain");
  c.velocity_feedforward =
      convert.template gain<typename S::VelocityWeight>(axis.feedforward.velocity, "feedforward.velocity", "weight");
  c.velocity_feedback = feedback_of(axis.encoder.velocity);
  set_pi(c.velocity, convert, axis.velocity_controller.gain, axis.velocity_controller.integral_time, period,
         "velocity_controller.gain", "velocity_controller.integral_time");
  if (axis.notch) {
    const Biquad q = discretise(*axis.notch, period);
    const auto coefficient = [&](double value) {
      return convert.template operator()<typename S::FilterCoefficient>(value, "notch", "filter coefficient");
    };
    c.notch = {true, coefficient(q.b0), coefficient(q.b1), {}, coefficient(q.a1), coefficient(q.a2)};
    // With b1 = a1 the gain at standstill is exactly 1 when b0 + b2 = 1 + a2 holds after rounding too.
    c.notch.b2 = coefficient(1.0 + to_si(c.notch.a2) - to_si(c.notch.b0));
  }
  c.current_feedforward = convert.template gain<typename S::AccelerationGain>(
      axis.feedforward.current * axis.mass / axis.motor.force_constant, "feedforward.current", "mass / force constant");

  c.current_loop = loop_of(axis.motor.model);
  const bool force_source = axis.motor.model == MotorModel::force;
  if (axis.current_controller)
    set_pi(c.current, convert, axis.current_controller->gain, axis.current_controller->integral_time, period,
           "current_controller.gain", "current_controller.integral_time");
  if (axis.motor.model == MotorModel::synchronous)
    c.inverse_pole_pair_pitch = convert.template gain<typename S::PitchInverse>(1.0 / axis.motor.pole_pair_pitch,
                                                                                "motor.pole_pair_pitch", "1 / pitch");

  const double current_limit =
      force_source ? axis.inverter.voltage_limit : axis.inverter.current_limit * axis.motor.count;
  const auto& watch = axis.supervision;
  c.velocity_limit = convert.template operator()<typename S::Velocity>(axis.max_velocity, "max_velocity", "limit");
  c.current_limit = convert.template operator()<typename S::Current>(current_limit, "inverter.current_limit", "limit");
  c.voltage_limit =
      convert.template operator()<typename S::Voltage>(axis.inverter.voltage_limit, "inverter.voltage_limit", "limit");
  c.following_error_fault = convert.template operator()<typename S::Distance>(watch.following_error.value_or(2e-3),
                                                                              "supervision.following_error", "limit");
  c.over_current_fault = convert.template operator()<typename S::Current>(
      watch.over_current.value_or(1.2 * current_limit), "supervision.over_current", "limit");
  c.over_speed_fault = convert.template operator()<typename S::Velocity>(
      watch.over_speed.value_or(1.2 * axis.max_velocity), "supervision.over_speed", "limit");
  // A speed whose motion between two samples leaves its format would be read too low, unseen.
  const int ticks_between =
      (axis.encoder.velocity == VelocitySource::mean_difference ? 2 : 1) + stiction::Axis<S>::missed_positions_allowed;
  const double fastest = std::max(axis.max_velocity, watch.over_speed.value_or(1.2 * axis.max_velocity));
  const double representable = highest<typename S::Step>() / (ticks_between * period);
  if (axis.encoder.velocity != VelocitySource::ideal && fastest > representable)
    throw ConfigurationError(
        fmt::format("axis.{}.max_velocity: found {:g} m/s with its over-speed limit; expected at most {:.3g} m/s at "
                    "this fast_period: "
                    "the motion over {} ticks, {} of them missed, must stay within the drive's number format",
                    axis.name, fastest, representable, ticks_between, stiction::Axis<S>::missed_positions_allowed));
  c.limit_cycle_window_ticks = static_cast<std::uint32_t>(std::lround(0.125 / period));
  return c;
}

template AxisConfig<FixedSignals> configure_axis<FixedSignals>(const Timing&, const AxisModel&);
template AxisConfig<DoubleSignals> configure_axis<DoubleSignals>(const Timing&, const AxisModel&);

}  // namespace stiction::machine
