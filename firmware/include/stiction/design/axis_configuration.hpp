// From a design in SI units to the configuration of the cascade: discretisation of the laws and conversion to the
// formats of the signal policy. The one place where this is done: machine files come here too. Whether a design makes
// sense is AxisDesign::validate()'s.
#pragma once

#include <cstdint>

#include "stiction/design/axis_parameters.hpp"
#include "stiction/design/conversion.hpp"
#include "stiction/drive/axis.hpp"

namespace stiction::design {

// Bilinear transform of Mendricky 2006, (3.19), with the frequency prewarped, so that the notch sits exactly at its
// frequency.
struct Biquad {
  double b0, b1, b2, a1, a2;
};
// `period`: s, of the fast tick. A template, as only GCC finds a tangent while compiling.
template <class Notch>
constexpr Biquad discretise(const Notch& notch, double period) {
  const double w = __builtin_tan(3.141592653589793 * notch.frequency * period);
  const double n = 2.0 * notch.numerator_damping * w;
  const double d = 2.0 * notch.denominator_damping * w;
  const double scale = 1.0 / (1.0 + d + w * w);
  return {(1.0 + n + w * w) * scale, 2.0 * (w * w - 1.0) * scale, (1.0 - n + w * w) * scale,
          2.0 * (w * w - 1.0) * scale, (1.0 - d + w * w) * scale};
}

// `notch`: frequency and dampings; `period`: s, of the fast tick; `convert`: takes the problems.
template <class S>
constexpr typename stiction::Notch<S>::Config configure_notch(const NotchParameters& notch, double period,
                                                              const Converter& convert) {
  if (notch.frequency == 0.0) return {};
  const Biquad q = discretise(notch, period);
  const auto coefficient = [&](double value) {
    return convert.template operator()<typename S::FilterCoefficient>(value, {"notch", "filter coefficient", ""});
  };
  typename stiction::Notch<S>::Config c{true, coefficient(q.b0), coefficient(q.b1),
                                        {},   coefficient(q.a1), coefficient(q.a2)};
  // With b1 = a1 the gain at standstill is exactly 1 when b0 + b2 = 1 + a2 holds after rounding too.
  c.b2 = coefficient(1.0 + design::to_si(c.a2) - design::to_si(c.b0));
  return c;
}

// Takes the integral part k T / T_N and, as tracking time, T_N itself: the excess behind a limit leaves the integrator
// as fast as an error entered it. `pi`: is written; `convert`: takes the problems; `controller`: gain and integral
// time; `period`: s, of the fast tick; `gain`, `time`: their names.
template <class Config>
constexpr void configure_pi(Config& pi, const Converter& convert, const PiParameters& controller, double period,
                            const Quantity& gain, const char* time) {
  pi.proportional = convert.template gain<decltype(pi.proportional)>(controller.gain, gain);
  if (controller.integral_time == 0.0) return;
  pi.integral = convert.template gain<decltype(pi.integral)>(controller.gain * period / controller.integral_time,
                                                             {time, "gain * period / time", gain.unit});
  pi.tracking =
      convert.template gain<decltype(pi.tracking)>(period / controller.integral_time, {time, "period / time", ""});
}

// A speed whose motion between two samples leaves its format would be read too low, unseen. `axis`: an AxisDesign;
// `over_speed`: its limit, m/s; `convert`: takes the problem.
template <class S, class Design>
constexpr void check_fastest(const Design& axis, double over_speed, const Converter& convert) {
  if (axis.encoder.velocity == VelocityFeedback::given) return;
  const bool mean = axis.encoder.velocity == VelocityFeedback::mean_difference;
  const int ticks_between = (mean ? 2 : 1) + stiction::Axis<S>::missed_positions_allowed;
  const double fastest = axis.max_velocity < over_speed ? over_speed : axis.max_velocity;
  const double representable = Format<typename S::Step>::highest() / (ticks_between * axis.timing.fast_period);
  static_assert(stiction::Axis<S>::missed_positions_allowed == 2, "the sentences below count them");
  if (fastest > representable)
    convert.refuse({{"max_velocity", "the faster of it and the over-speed limit", "m/s"},
                    fastest,
                    "at most",
                    representable,
                    mean ? " at this fast_period: the motion over 4 ticks, 2 of them missed, must stay within the "
                           "drive's number format"
                         : " at this fast_period: the motion over 3 ticks, 2 of them missed, must stay within the "
                           "drive's number format"});
}

// `axis`: an AxisDesign; `problems`: takes what the formats do not hold, the first one first. S: FixedSignals, or a
// policy for whose types Format is specialised.
template <class S, class Design>
constexpr AxisConfig<S> configure_axis(const Design& axis, Problems& problems) {
  const Converter convert(problems);
  const double period = axis.timing.fast_period;
  const bool force_source = axis.motor.loop == CurrentLoop::none;
  const char* ampere = force_source ? "V" : "A";
  AxisConfig<S> c;
  c.period_ns = nearest(period * 1e9);
  if (!Format<typename S::PeriodInverse>::convert(1e-9 / period, c.inverse_period))
    convert.refuse({{"timing.fast_period", "", "us"},
                    period * 1e6,
                    "at least",
                    1e-3 / Format<typename S::PeriodInverse>::highest(),
                    ", the range of the drive's number format"});
  if (axis.position_controller.increment > 0.0) {
    const double increment = axis.position_controller.increment;
    const char* key = "position_controller.increment";
    c.quantizer = {true,
                   convert.template gain<typename S::IncrementInverse>(1.0 / increment, {key, "1 / increment", "1/m"}),
                   convert.template gain<typename S::Increment>(increment, {key, "", "m"})};
  }
  c.position_gain = convert.template gain<typename S::PositionGain>(axis.position_controller.gain,
                                                                    {"position_controller.gain", "", "1/s"});
  c.velocity_feedforward =
      convert.template gain<typename S::VelocityWeight>(axis.feedforward.velocity, {"feedforward.velocity", "", ""});
  c.velocity_feedback = axis.encoder.velocity;
  configure_pi(c.velocity, convert, axis.velocity_controller, period,
               {"velocity_controller.gain", "", force_source ? "V s/m" : "A s/m"}, "velocity_controller.integral_time");
  c.notch = configure_notch<S>(axis.notch, period, convert);
  c.current_feedforward = convert.template gain<typename S::AccelerationGain>(
      axis.feedforward.current * axis.mass / axis.motor.force_constant,
      {"feedforward.current", "mass / force constant", force_source ? "V s^2/m" : "A s^2/m"});

  c.current_loop = axis.motor.loop;
  configure_pi(c.current, convert, axis.current_controller, period, {"current_controller.gain", "", "V/A"},
               "current_controller.integral_time");
  if (has_phases(axis.motor.loop))
    c.inverse_pole_pair_pitch = convert.template gain<typename S::PitchInverse>(
        1.0 / axis.motor.pole_pair_pitch, {"motor.pole_pair_pitch", "1 / pitch", "1/m"});

  const double current_limit = largest_current(axis.motor, axis.inverter);
  const double over_speed = axis.supervision.over_speed == 0.0 ? 1.2 * axis.max_velocity : axis.supervision.over_speed;
  c.velocity_limit = convert.template operator()<typename S::Velocity>(axis.max_velocity, {"max_velocity", "", "m/s"});
  c.current_limit =
      convert.template operator()<typename S::Current>(current_limit, {"inverter.current_limit", "", ampere});
  c.voltage_limit = convert.template operator()<typename S::Voltage>(axis.inverter.voltage_limit,
                                                                     {"inverter.voltage_limit", "", "V"});
  c.following_error_fault = convert.template operator()<typename S::Distance>(
      axis.supervision.following_error == 0.0 ? default_following_error : axis.supervision.following_error,
      {"supervision.following_error", "", "m"});
  c.over_current_fault = convert.template operator()<typename S::Current>(
      axis.supervision.over_current == 0.0 ? 1.2 * current_limit : axis.supervision.over_current,
      {"supervision.over_current", "", ampere});
  c.over_speed_fault =
      convert.template operator()<typename S::Velocity>(over_speed, {"supervision.over_speed", "", "m/s"});
  check_fastest<S>(axis, over_speed, convert);
  c.limit_cycle_window_ticks = static_cast<std::uint32_t>(nearest(0.125 / period));
  return c;
}

}  // namespace stiction::design
