#include "firmware/stictiond/gpio_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/gpio/lines.hpp"

namespace stiction::drive {
namespace {

hal::LineConfig line(int number, machine::ActiveLevel active = machine::ActiveLevel::high) {
  return {.offset = number, .active_low = active == machine::ActiveLevel::low};
}

std::int64_t ns(double seconds) { return std::llround(seconds * 1e9); }

hal::AxisLines lines_of(const std::string& axis, const machine::LineSetup& setup) {
  return {.name = axis,
          .enable = line(setup.enable, setup.enable_active),
          .brake = line(setup.brake, setup.brake_active),
          .fault = line(setup.fault, setup.fault_active),
          .limit_negative = line(setup.limit_negative, setup.limit_active),
          .limit_positive = line(setup.limit_positive, setup.limit_active),
          .home = line(setup.home, setup.home_active),
          .index = line(setup.index, setup.index_active),
          .torque_off_a = line(setup.torque_off_a, setup.torque_off_active),
          .torque_off_b = line(setup.torque_off_b, setup.torque_off_active),
          .hall_a = line(setup.hall_a, setup.hall_active),
          .hall_b = line(setup.hall_b, setup.hall_active),
          .hall_c = line(setup.hall_c, setup.hall_active)};
}

hal::GpioAxisConfig configuration_of(const machine::AxisModel& axis, const machine::LineSetup& setup,
                                     const machine::GpioSetup& gpio, bool takes_over) {
  if (axis.motor.model != machine::MotorModel::force)
    throw hal::GpioError(
        fmt::format("axis {}: its current controllers need the phase currents, which GPIO does not carry; "
                    "use --hal can, or a power stage that takes a voltage (motor model \"force\")",
                    axis.name));
  return {
      .lines = lines_of(axis.name, setup),
      .encoder = {.a = line(setup.quadrature_a),
                  .b = line(setup.quadrature_b),
                  .increment = setup.quadrature_increment > 0.0 ? setup.quadrature_increment : axis.encoder.increment,
                  .rate = setup.quadrature_rate,
                  .settle_ns = ns(setup.quadrature_settle)},
      .pwm = {.chip = *gpio.pwm_chip,
              .first_channel = setup.pwm_channel,
              .half_bridges = 2,
              .period_ns = ns(gpio.pwm_period),
              .dc_link = gpio.dc_link,
              .takes_over = takes_over}};
}

}  // namespace

hal::Bias input_bias(const machine::DriveSetup& setup) {
  static constexpr std::array biases{hal::Bias::as_is, hal::Bias::pull_up, hal::Bias::pull_down, hal::Bias::none};
  return setup.gpio ? biases[static_cast<std::size_t>(setup.gpio->bias)] : hal::Bias::as_is;
}

hal::WatchdogConfig watchdog_config(const machine::DriveSetup& setup) {
  if (!setup.gpio) return {};
  return {.line = line(setup.gpio->watchdog), .period_ns = ns(setup.gpio->watchdog_period)};
}

std::vector<hal::AxisLines> gpio_lines(const machine::DriveSetup& setup, const machine::Machine& machine) {
  std::vector<hal::AxisLines> lines;
  for (const auto& axis : machine.axes) lines.push_back(lines_of(axis.name, setup.axes.at(axis.name).line));
  return lines;
}

std::vector<hal::LineConfig> track_lines(const machine::DriveSetup& setup) {
  std::vector<hal::LineConfig> lines;
  for (const auto* track : machine::tracks_of(setup.cam_switch))
    lines.push_back({.offset = track->line, .active_low = track->active_low});
  return lines;
}

bool has_gpio_lines(const machine::DriveSetup& setup, const machine::Machine& machine) {
  const auto lines = gpio_lines(setup, machine);
  if (watchdog_config(setup).line.wired()) return true;
  const auto tracks = track_lines(setup);
  if (setup.gpio && std::any_of(tracks.begin(), tracks.end(), [](const auto& track) { return track.wired(); }))
    return true;
  return setup.gpio && std::any_of(lines.begin(), lines.end(), [](const hal::AxisLines& axis) {
           return axis.enable.wired() || axis.brake.wired() || axis.fault.wired() || axis.limit_negative.wired() ||
                  axis.limit_positive.wired() || axis.home.wired() || axis.index.wired() || axis.torque_off_a.wired() ||
                  axis.torque_off_b.wired() || axis.hall_a.wired() || axis.hall_b.wired() || axis.hall_c.wired();
         });
}

hal::GpioBackendConfig gpio_configuration(const machine::DriveSetup& setup, const machine::Machine& machine,
                                          bool takes_over) {
  if (!setup.gpio) throw hal::GpioError("the machine file has no table [drive.gpio]; name the gpiochip there");
  if (!setup.gpio->pwm_chip)
    throw hal::GpioError("[drive.gpio] names no pwm_chip; expected a folder of /sys/class/pwm");
  hal::GpioBackendConfig config{.chip = setup.gpio->chip,
                                .bias = input_bias(setup),
                                .axes = {},
                                .watchdog = watchdog_config(setup),
                                .tracks = track_lines(setup)};
  for (const auto& axis : machine.axes)
    config.axes.push_back(configuration_of(axis, setup.axes.at(axis.name).line, *setup.gpio, takes_over));
  return config;
}

}  // namespace stiction::drive
