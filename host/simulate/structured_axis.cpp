#include "host/simulate/structured_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiction::host {

double StructuredAxis::ProportionalIntegral::advance(double error, double added, double limit) {
  const double total = sum + error * step;
  const double wanted = gain * (error + total) + added, output = std::clamp(wanted, -limit, limit);
  if (output == wanted) sum = total;
  return output;
}

StructuredAxis::StructuredAxis(const machine::Timing& timing, const machine::AxisModel& axis)
    : structure_(axis.controller->structure),
      source_(axis.encoder.velocity),
      ticks_per_period_(std::llround(axis.controller->period.value_or(timing.fast_period) / timing.fast_period)),
      period_(static_cast<double>(ticks_per_period_) * timing.fast_period),
      derivative_(axis.controller->derivative),
      limit_(axis.controller->supply.value_or(
          axis.controller->in_volts ? axis.inverter.voltage_limit : axis.inverter.current_limit * axis.motor.count)),
      voltage_limit_(axis.inverter.voltage_limit),
      pitch_(axis.motor.model == machine::MotorModel::synchronous ? axis.motor.pole_pair_pitch : 0.0),
      current_loop_(axis.current_controller.has_value()),
      electrical_(axis.motor.model != machine::MotorModel::force) {
  const auto& controller = *axis.controller;
  law_ = {controller.gain, controller.integral_time ? period_ / *controller.integral_time : 0.0};
  if (const auto& current = axis.current_controller)
    current_laws_.fill({current->gain, current->integral_time ? timing.fast_period / *current->integral_time : 0.0});
}

double StructuredAxis::speed(const Seen& seen) {
  if (source_ == machine::VelocitySource::ideal) return seen.velocity;
  const double x = seen.velocity_encoder.value_or(seen.position);
  const double last = last_.value_or(x);
  last_ = x;
  if (source_ == machine::VelocitySource::estimated) return (x - last) / period_;
  const double mean = 0.5 * (x + last), before = mean_.value_or(x);
  mean_ = mean;
  return (mean - before) / period_;
}

StructuredAxis::Command StructuredAxis::tick(const sim::AxisSetPoint& set, const Seen& seen) {
  if (tick_++ % ticks_per_period_ == 0) {
    const double damped =
        structure_ == machine::ControlStructure::p_voltage ? 0.0 : derivative_ * (set.velocity - speed(seen));
    held_ = law_.advance(set.position - seen.position, damped, limit_);
  }
  Command command{held_ + set.injection, {}, 0.0};
  const double third = 2.0 * std::numbers::pi / 3.0;
  const double angle =
      pitch_ > 0.0 ? 2.0 * std::numbers::pi * seen.velocity_encoder.value_or(seen.position) / pitch_ : 0.0;
  const std::size_t phases = pitch_ > 0.0 ? 3 : 1;
  for (std::size_t k = 0; k < phases; ++k) {
    const double share = pitch_ > 0.0 ? std::sin(angle + static_cast<double>(k) * third) : 1.0;
    command.voltage[k] = current_loop_
                             ? current_laws_[k].advance(command.output * share - seen.current[k], 0.0, voltage_limit_)
                             : command.output;
    command.current += (pitch_ > 0.0 ? 2.0 / 3.0 : 1.0) * share * seen.current[k];
  }
  if (!electrical_) command.current = command.output;
  return command;
}

}  // namespace stiction::host
