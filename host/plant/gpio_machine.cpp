#include "host/plant/gpio_machine.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::host {
namespace {

constexpr bool high_when_active(machine::ActiveLevel level) { return level == machine::ActiveLevel::high; }

void put(plant::GpioSim& chip, int line, machine::ActiveLevel level, bool active) {
  if (line >= 0) chip.set(line, active == high_when_active(level));
}

std::filesystem::path chip_folder(const std::string& chip) {
  const auto folder = plant::GpioSim::find(chip);
  if (!folder)
    throw plant::GpioSimError(
        fmt::format("gpio-sim: found no simulated gpiochip \"{}\"; expected one with this label: create it through "
                    "/sys/kernel/config/gpio-sim (kernel with CONFIG_GPIO_SIM, as root), or name it in drive.gpio.chip",
                    chip));
  return *folder;
}

int channels_of(const GpioMachineConfig& config) {
  int channels = 0;
  for (const auto& axis : config.axes) channels = std::max(channels, axis.line.pwm_channel + 2);
  return channels;
}

}  // namespace

GpioMachineConfig gpio_machine_config(const machine::Machine& machine, const machine::DriveSetup& setup,
                                      std::span<const double> start, std::span<const hal::AxisMarks> marks) {
  if (!setup.gpio || !setup.gpio->pwm_chip)
    throw plant::GpioSimError(fmt::format(
        "{}: found no table [drive.gpio] with chip and pwm_chip; expected the lines to simulate", machine.id));
  GpioMachineConfig config{.chip = setup.gpio->chip,
                           .pwm = *setup.gpio->pwm_chip,
                           .pwm_period_ns = std::llround(setup.gpio->pwm_period * 1e9),
                           .dc_link = setup.gpio->dc_link,
                           .period_ns = machine::fast_period_ns(machine.timing),
                           .axes = {}};
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto& axis = machine.axes[i];
    const auto& line = setup.axes.at(axis.name).line;
    if (line.enable < 0 || line.quadrature_a < 0 || line.quadrature_b < 0 || line.pwm_channel < 0)
      throw plant::GpioSimError(
          fmt::format("{}: axis {}: found no enable, quadrature_a, quadrature_b or pwm_channel in "
                      "[drive.axis.{}.line]; expected all of them",
                      machine.id, axis.name, axis.name));
    const double increment = line.quadrature_increment > 0.0 ? line.quadrature_increment : axis.encoder.increment;
    const auto counts = [&](double way) { return std::llround(way / increment); };
    config.axes.push_back({.line = line, .increment = increment, .start = start[i], .index = {}});
    if (const auto& mark = marks[i]; mark.index)
      config.axes.back().index = {counts(*mark.index), counts(mark.index_every)};
  }
  return config;
}

GpioMachine::GpioMachine(const GpioMachineConfig& config, PlantUnderBus plant, const FaultSchedule& faults)
    : config_(config),
      plant_(std::move(plant)),
      faults_(faults),
      chip_(chip_folder(config.chip)),
      pwm_(config.pwm, channels_of(config)),
      commands_(config.axes.size()),
      feedback_(config.axes.size()),
      inputs_(config.axes.size()),
      protection_(config.axes.size()) {
  for (const auto& axis : config.axes)
    encoders_.emplace_back(chip_,
                           plant::EncoderLines::Wiring{.a = axis.line.quadrature_a,
                                                       .b = axis.line.quadrature_b,
                                                       .index = axis.line.index,
                                                       .index_active_low = !high_when_active(axis.line.index_active),
                                                       .marks = axis.index},
                           std::llround(axis.start / axis.increment));
  plant_.sample(feedback_, inputs_);
  plant_.sample_protection(protection_);
  set_switches();
}

void GpioMachine::serve(const std::function<bool()>& stop) {
  // Sleeps of this thread end on time and not up to 50 us later, as the kernel otherwise allows itself.
  ::prctl(PR_SET_TIMERSLACK, 1ul, 0ul, 0ul, 0ul);
  hal::TickClock clock(config_.period_ns);
  while (!stop()) {
    const std::int64_t now_ns = clock.wait();
    // Ticks that this process missed pass in the plant too; their edges come now.
    for (std::uint64_t i = 0; i < clock.missed_before(); ++i, ++tick_) plant_.advance(commands_);
    tick(now_ns);
  }
}

void GpioMachine::tick(std::int64_t time_ns) {
  const hal::MonotonicTime clock;
  clock.sleep_until(time_ns);
  take_commands();
  plant_.advance(commands_);
  ++tick_;
  plant_.sample(feedback_, inputs_);
  plant_.sample_protection(protection_);
  set_switches();
  edges_.clear();
  for (std::size_t i = 0; i < encoders_.size(); ++i) plan_edges(i, time_ns);
  std::stable_sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.time_ns < b.time_ns; });
  for (const auto& edge : edges_) {
    clock.sleep_until(edge.time_ns);
    encoders_[edge.axis].step(edge.forward);
  }
}

// Voltage between the outputs of a full bridge: duty = 1/2 +- u / (2 u_dc), hal/gpio/pwm.hpp.
void GpioMachine::take_commands() {
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const auto& line = config_.axes[i].line;
    const auto duty_ns = pwm_.duty_ns(line.pwm_channel) - pwm_.duty_ns(line.pwm_channel + 1);
    const double voltage = config_.dc_link * static_cast<double>(duty_ns) / static_cast<double>(config_.pwm_period_ns);
    auto& command = commands_[i];
    command.enable = chip_.driven(line.enable) == high_when_active(line.enable_active) &&
                     machine::convert(voltage, command.voltage[0]);
    if (line.brake >= 0) plant_.set_brake(i, chip_.driven(line.brake) != high_when_active(line.brake_active));
  }
}

void GpioMachine::set_switches() {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const auto& line = config_.axes[i].line;
    put(chip_, line.limit_negative, line.limit_active, inputs_[i].limit_negative);
    put(chip_, line.limit_positive, line.limit_active, inputs_[i].limit_positive);
    put(chip_, line.home, line.home_active, inputs_[i].home);
    put(chip_, line.fault, line.fault_active, feedback_[i].fault);
    put(chip_, line.torque_off_a, line.torque_off_active, protection_[i].torque_off_a);
    put(chip_, line.torque_off_b, line.torque_off_active, protection_[i].torque_off_b);
    put(chip_, line.hall_a, line.hall_active, (inputs_[i].hall & 1) != 0);
    put(chip_, line.hall_b, line.hall_active, (inputs_[i].hall & 2) != 0);
    put(chip_, line.hall_c, line.hall_active, (inputs_[i].hall & 4) != 0);
  }
}

void GpioMachine::plan_edges(std::size_t axis, std::int64_t time_ns) {
  auto& encoder = encoders_[axis];
  if (faulty(LineFaultKind::tracks_together, axis)) encoder.slip();
  if (!feedback_[axis].position_valid) return;
  const std::int64_t target = std::llround(machine::to_si(feedback_[axis].position) / config_.axes[axis].increment);
  const std::int64_t way = std::abs(target - encoder.count());
  if (way > most_played) return encoder.reconnect(target);
  constexpr std::int64_t noise_edges = 20;  // forth and back
  const std::int64_t noise = faulty(LineFaultKind::track_noise, axis) ? noise_edges : 0;
  const bool forward = target > encoder.count();
  for (std::int64_t i = 0; i < way + noise; ++i)
    edges_.push_back({.time_ns = time_ns + (2 * i + 1) * config_.period_ns / (2 * (way + noise)),
                      .axis = axis,
                      .forward = i < noise ? i % 2 == 0 : forward});
  most_edges_ = std::max(most_edges_, way + noise);
}

bool GpioMachine::faulty(LineFaultKind kind, std::size_t axis) const {
  return faults_.acts(&PlantFaultKind::line, kind, axis, tick_);
}

}  // namespace stiction::host
