#include "firmware/machine/configuration/motor_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

constexpr double zero_celsius = 273.15;  // K

template <class T>
T held(double value, const std::string& axis, const char* key) {
  if (const auto signal = to_signal<T>(value)) return *signal;
  throw ConfigurationError(
      fmt::format("drive.axis.{}.{}: found {:g}; expected at most {:g} in magnitude, the range of the drive's number "
                  "format",
                  axis, key, value, highest<T>()));
}

Turn turn_of(double radians) {
  const double turns = radians / (2.0 * std::numbers::pi);
  return Turn{
      static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround((turns - std::floor(turns)) * 0x1p32)))};
}

template <class S>
CommutationConfig<S> commutation_of(const AxisModel& axis, const CommutationSetup& setup) {
  CommutationConfig<S> c;
  if (setup.method == CommutationSource::encoder_zero) return c;
  if (axis.motor.model != MotorModel::synchronous)
    throw ConfigurationError(fmt::format(
        "drive.axis.{}.commutation.method: found one on a motor without phases; expected encoder-zero, which "
        "is the default",
        axis.name));
  switch (setup.method) {
    case CommutationSource::encoder_zero:
      break;
    case CommutationSource::stored:
      c.method = CommutationMethod::stored;
      break;
    case CommutationSource::test:
      c.method = CommutationMethod::test;
      break;
    case CommutationSource::hall:
      c.method = CommutationMethod::hall;
      break;
  }
  const double pitch = axis.motor.pole_pair_pitch, limit = axis.inverter.current_limit * axis.motor.count;
  const double response = setup.test_response.value_or(std::max(pitch / 4000.0, 4.0 * axis.encoder.increment));
  c.offset = turn_of(setup.offset);
  c.checked = setup.checked;
  c.tolerance = turn_of(setup.tolerance);
  c.index_known = setup.index_offset.has_value();
  c.index_angle = turn_of(setup.index_offset.value_or(0.0));
  c.inverse_pole_pair_pitch = held<typename S::PitchInverse>(1.0 / pitch, axis.name, "commutation.method");
  c.most_current = held<typename S::Current>(std::min(setup.test_current.value_or(0.5 * limit), limit), axis.name,
                                             "commutation.test_current");
  c.response = held<typename S::Position>(response, axis.name, "commutation.test_response");
  c.longest_way = held<typename S::Position>(setup.test_way.value_or(std::max(pitch / 50.0, 16.0 * response)),
                                             axis.name, "commutation.test_way");
  return c;
}

template <class S>
ProtectionConfig<S> protection_of(const Timing& timing, const AxisModel& axis, const ProtectionSetup& setup) {
  ProtectionConfig<S> c;
  c.three_phase = axis.motor.model == MotorModel::synchronous;
  const double step = timing.fast_period * Protection<FixedSignals>::ticks_a_step;
  if (setup.motor_current) c.motor = thermal_model(*setup.motor_current, setup.motor_time_constant, step);
  if (setup.stage_current) c.stage = thermal_model(*setup.stage_current, setup.stage_time_constant, step);
  c.watches_dc_high = setup.dc_link_high.has_value();
  c.watches_dc_low = setup.dc_link_low.has_value();
  c.dc_link_high = held<typename S::Voltage>(setup.dc_link_high.value_or(0.0), axis.name, "protection.dc_link_high");
  c.dc_link_low = held<typename S::Voltage>(setup.dc_link_low.value_or(0.0), axis.name, "protection.dc_link_low");
  c.watches_motor_temperature = setup.motor_temperature.has_value();
  c.watches_stage_temperature = setup.stage_temperature.has_value();
  const auto tenths = [&](const std::optional<double>& kelvin, const char* key) -> std::int16_t {
    if (!kelvin) return 0;
    const double celsius = *kelvin - zero_celsius;
    if (celsius >= 0.1 * Protection<FixedSignals>::coldest && celsius <= 0.1 * Protection<FixedSignals>::hottest)
      return static_cast<std::int16_t>(std::lround(10.0 * celsius));
    throw ConfigurationError(
        fmt::format("drive.axis.{}.protection.{}: found {:g} K; expected a temperature that a sensor shows, 218.15 to "
                    "573.15 K",
                    axis.name, key, *kelvin));
  };
  c.motor_temperature = tenths(setup.motor_temperature, "motor_temperature");
  c.stage_temperature = tenths(setup.stage_temperature, "stage_temperature");
  c.torque_off_wired = setup.torque_off;
  c.used = setup.motor_current || setup.stage_current || c.watches_dc_high || c.watches_dc_low ||
           c.watches_motor_temperature || c.watches_stage_temperature || c.torque_off_wired;
  return c;
}

}  // namespace

// A body keeps its heat over a step, so that the share is exact for every time constant.
ThermalModel::Config thermal_model(double current, double time_constant, double step) {
  return {std::llround(0x1p36 / (current * current)), std::llround(-std::expm1(-step / time_constant) * 0x1p56)};
}

template <class S>
void configure_motor(const Timing& timing, const AxisModel& axis, const DriveAxisSetup& setup,
                     ServoDriveConfig<S>& config) {
  config.commutation = commutation_of<S>(axis, setup.commutation);
  config.protection = protection_of<S>(timing, axis, setup.protection);
  const auto& test = setup.brake_test;
  config.brake_test.current = held<typename S::Current>(test.current, axis.name, "brake_test.current");
  config.brake_test.way = held<typename S::Position>(test.way, axis.name, "brake_test.way");
  config.brake_test.ticks = static_cast<std::uint32_t>(std::lround(std::ceil(test.time / timing.fast_period)));
}

template void configure_motor<FixedSignals>(const Timing&, const AxisModel&, const DriveAxisSetup&,
                                            ServoDriveConfig<FixedSignals>&);
template void configure_motor<DoubleSignals>(const Timing&, const AxisModel&, const DriveAxisSetup&,
                                             ServoDriveConfig<DoubleSignals>&);

}  // namespace stiction::machine
