#include "host/diagnose/record/encoder_error_response.hpp"

#include <cmath>
#include <numbers>

#include "firmware/machine/model/motor_force.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

// PI with the integrator updated before use; `back` is one tick back, z^-1.
Complex pi(double gain, const std::optional<double>& integral_time, double tick, Complex back) {
  return integral_time ? gain * (1.0 + tick / *integral_time / (1.0 - back)) : Complex(gain);
}

// Bilinear transform of s^2 + 2 D1 w s + w^2 over s^2 + 2 D2 w s + w^2, prewarped.
Complex notch_of(const machine::NotchParameters& notch, double tick, Complex back) {
  const double w = std::tan(std::numbers::pi * notch.frequency * tick);
  const Complex s = (1.0 - back) / (1.0 + back) / w;
  return (s * s + 2.0 * notch.numerator_damping * s + 1.0) / (s * s + 2.0 * notch.denominator_damping * s + 1.0);
}

}  // namespace

EncoderErrorResponse::EncoderErrorResponse(const machine::AxisModel& axis, const machine::Timing& timing,
                                           double log_period)
    : axis_(axis), tick_(timing.fast_period), log_period_(log_period) {}

double EncoderErrorResponse::shown_at(double frequency) const {
  const double rate = 1.0 / log_period_;
  return std::abs(frequency - rate * std::round(frequency / rate));
}

Complex EncoderErrorResponse::operator()(double frequency) const {
  const double w = 2.0 * std::numbers::pi * shown_at(frequency);
  const Complex acceleration = axis_.mass * w * w;
  return frequency < 0.5 / log_period_ ? acceleration : acceleration + drive(frequency);
}

// Set current to current: PI, dead time, and windings under a voltage held for a tick.
Complex EncoderErrorResponse::current_loop(Complex back) const {
  const auto& motor = axis_.motor;
  if (motor.model == machine::MotorModel::force || !axis_.current_controller) return 1.0;
  const double mutual = motor.model == machine::MotorModel::synchronous ? motor.mutual_inductance : 0.0;
  const double resistance = motor.phase_resistance / motor.count;
  const double inductance = (motor.phase_inductance - mutual) / motor.count;
  const double decay = std::exp(-resistance * tick_ / inductance);
  const Complex windings = (1.0 - decay) / resistance * back / (1.0 - decay * back);
  const Complex open = pi(axis_.current_controller->gain, axis_.current_controller->integral_time, tick_, back) *
                       std::pow(back, std::round(axis_.inverter.dead_time / tick_)) * windings;
  return open / (1.0 + open);
}

Complex EncoderErrorResponse::drive(double frequency) const {
  if (!(tick_ > 0.0) || axis_.velocity_controller.gain == 0.0) return 0.0;
  const double w = 2.0 * std::numbers::pi * frequency;
  const Complex back = std::polar(1.0, -w * tick_);
  if (std::abs(1.0 - back) < 1e-9) return 0.0;
  Complex speed = (1.0 - back) / tick_;
  if (axis_.encoder.velocity == machine::VelocitySource::mean_difference) speed = (1.0 - back * back) / (2.0 * tick_);
  if (axis_.encoder.velocity == machine::VelocitySource::ideal) speed = {0.0, w};
  Complex answer = speed * pi(axis_.velocity_controller.gain, axis_.velocity_controller.integral_time, tick_, back) *
                   current_loop(back) * machine::acting_force_constant(axis_.motor);
  if (axis_.notch) answer *= notch_of(*axis_.notch, tick_, back);
  // x = F / (m s^2) is read with the error.
  return -answer / (1.0 - answer / (axis_.mass * w * w));
}

}  // namespace stiction::host
