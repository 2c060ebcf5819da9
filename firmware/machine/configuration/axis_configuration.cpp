#include "firmware/machine/configuration/axis_configuration.hpp"

#include <fmt/format.h>

#include <cmath>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/design/axis_configuration.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

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

}  // namespace

std::int64_t fast_period_ns(const Timing& timing) { return std::llround(timing.fast_period * 1e9); }
int slow_ratio(const Timing& timing) { return static_cast<int>(std::lround(timing.slow_period / timing.fast_period)); }

AxisDesign design_of(const Timing& timing, const AxisModel& axis) {
  AxisDesign d;
  d.timing = {timing.fast_period, timing.slow_period};
  d.mass = axis.mass;
  d.max_velocity = axis.max_velocity;
  d.motor = {loop_of(axis.motor.model), axis.motor.force_constant, axis.motor.pole_pair_pitch, axis.motor.count};
  d.inverter = {axis.inverter.voltage_limit, axis.inverter.current_limit};
  // A velocity encoder of its own gives the speed, whatever it is computed from.
  d.encoder.velocity = axis.velocity_encoder ? VelocityFeedback::given : feedback_of(axis.encoder.velocity);
  d.position_controller = {axis.position_controller.gain, axis.position_controller.increment};
  d.velocity_controller = {axis.velocity_controller.gain, axis.velocity_controller.integral_time.value_or(0.0)};
  if (const auto& c = axis.current_controller) d.current_controller = {c->gain, c->integral_time.value_or(0.0)};
  if (const auto& notch = axis.notch)
    d.notch = {notch->frequency, notch->numerator_damping, notch->denominator_damping};
  d.feedforward = {axis.feedforward.velocity, axis.feedforward.current};
  const auto& watch = axis.supervision;
  d.supervision = {watch.following_error.value_or(0.0), watch.over_current.value_or(0.0),
                   watch.over_speed.value_or(0.0)};
  return d;
}

void refuse(const design::Problems& problems, const std::string& axis) {
  if (problems.empty()) return;
  const std::string sentence = problems[0].sentence().c_str();
  throw ConfigurationError(sentence.starts_with("timing.") ? sentence : fmt::format("axis.{}.{}", axis, sentence));
}

template <class S>
AxisConfig<S> configure_axis(const Timing& timing, const AxisModel& axis) {
  design::Problems problems;
  const auto config = design::configure_axis<S>(design_of(timing, axis), problems);
  // A number in the units of no radius that the axis has would tell nobody anything.
  if (!problems.empty() && !axis.beyond_formats.empty()) throw ConfigurationError(axis.beyond_formats);
  refuse(problems, axis.name);
  return config;
}

template AxisConfig<FixedSignals> configure_axis<FixedSignals>(const Timing&, const AxisModel&);
template AxisConfig<DoubleSignals> configure_axis<DoubleSignals>(const Timing&, const AxisModel&);

}  // namespace stiction::machine
