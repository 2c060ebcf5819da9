#include "hal/gpio/gpio_backend.hpp"

#include <fmt/format.h>

#include <array>

namespace stiction::hal {
namespace {

// Half bridges rest at half of the rails with their low sides on as long as on their high sides: without an enable
// input nothing turns them off.
std::vector<AxisLines> checked_lines(const GpioBackendConfig& config) {
  std::vector<AxisLines> lines;
  for (const auto& axis : config.axes) {
    if (!axis.lines.enable.wired())
      throw GpioError(fmt::format(
          "axis {}: no enable line; it is the only way to switch off a power stage with PWM input, so set line.enable",
          axis.lines.name));
    lines.push_back(axis.lines);
  }
  return lines;
}

}  // namespace

GpioBackend::GpioBackend(const GpioBackendConfig& config, std::int64_t period_ns)
    : clock_(period_ns),
      lines_(config.chip, config.bias),
      io_(lines_, checked_lines(config), config.watchdog, config.tracks) {
  for (const auto& axis : config.axes) axes_.push_back(std::make_unique<Axis>(lines_, axis));
}

GpioBackend::~GpioBackend() {
  for (std::size_t i = 0; i < axes_.size(); ++i) io_.set_enable(i, false);
}

std::int64_t GpioBackend::wait_for_tick() {
  const std::int64_t now_ns = now_ns_ = clock_.wait();
  lines_.poll(now_ns);
  if (clock_.first_tick()) {
    // What moved while the programme was getting ready is not a fault of the encoder.
    for (auto& axis : axes_) axis->encoder.restart();
    lines_.poll(now_ns);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i)
    axes_[i]->encoder.update(now_ns, io_.index_edges(i), io_.index_queue_was_full(i));
  return now_ns;
}

void GpioBackend::read(std::span<Feedback<Signals>> feedback) const {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto& encoder = axes_[i]->encoder;
    feedback[i] = {.position = encoder.position(),
                   .position_time_ns = encoder.time_ns(),
                   .position_valid = encoder.valid(),
                   .fault = io_.fault(i) || axes_[i]->bridge.failed()};
  }
}

// Off: first the power stage, then the voltage; on: the other way round.
void GpioBackend::write(std::span<const Command<Signals>> command) {
  static constexpr std::array<Signals::Voltage, 3> zero{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!command[i].enable) io_.set_enable(i, false);
    axes_[i]->bridge.write(command[i].enable ? command[i].voltage : zero);
    if (command[i].enable) io_.set_enable(i, true);
  }
  io_.pulse(now_ns_);
}

void GpioBackend::read_inputs(std::span<DigitalInputs<Signals>> inputs) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    inputs[i] = {};
    io_.read_inputs(i, inputs[i]);
    const auto index = axes_[i]->encoder.take_index();
    inputs[i].index = index.has_value();
    if (index) inputs[i].index_position = *index;
  }
}

void GpioBackend::read_protection(std::span<ProtectionInputs<Signals>> inputs) const {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    inputs[i] = {};
    io_.read_protection(i, inputs[i]);
  }
}

std::uint64_t GpioBackend::lost_edges(std::size_t axis) const {
  return io_.lost_edges(axis) + axes_[axis]->encoder.lost_edges();
}

}  // namespace stiction::hal
