#include "host/plant/modbus_slave.hpp"

#include <array>
#include <utility>

#include "firmware/machine/configuration/conversion.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::host {

ModbusSlave::ModbusSlave(const std::string& address, std::int64_t period_ns, PlantUnderBus plant)
    : period_ns_(period_ns),
      plant_(std::move(plant)),
      server_(hal::power_stage_map(), {.address = address, .motion_allowed = true},
              [this](std::span<double> values) { hal::put_power_stage_values(state_.latest(), values); }) {}

void ModbusSlave::serve(const std::function<bool()>& stop) {
  hal::TickClock clock(period_ns_);
  publish();
  while (!stop()) {
    const std::int64_t now_ns = clock.wait();
    take_writes(now_ns);
    enabled_ = command_.enable && heard_ns_ != 0 && now_ns - heard_ns_ <= silence_ns;
    std::array<Command<FixedSignals>, 1> acting{};
    acting[0].enable = enabled_ && machine::convert(command_.voltage, acting[0].voltage[0]);
    // Ticks that this process missed pass in the plant too.
    for (std::uint64_t i = 0; i <= clock.missed_before(); ++i, ++ticks_) plant_.advance(acting);
    publish();
  }
}

void ModbusSlave::take_writes(std::int64_t now_ns) {
  const std::uint16_t cycle = command_.cycle;
  while (const auto write = server_.take_write()) hal::apply(*write, command_);
  if (command_.cycle != cycle) heard_ns_ = now_ns;
}

void ModbusSlave::publish() {
  std::array<Feedback<FixedSignals>, 1> feedback{};
  std::array<DigitalInputs<FixedSignals>, 1> inputs{};
  std::array<ProtectionInputs<FixedSignals>, 1> protection{};
  plant_.sample(feedback, inputs);
  plant_.sample_protection(protection);
  const auto has = plant_.motor_signals(0);
  const auto& f = feedback[0];
  auto& state = state_.next();
  state.fault = f.fault || !f.position_valid;
  state.limit_negative = inputs[0].limit_negative;
  state.limit_positive = inputs[0].limit_positive;
  state.home = inputs[0].home;
  state.enabled = enabled_;
  state.cycle = static_cast<std::uint16_t>(ticks_);
  state.position = machine::to_si(f.position);
  state.velocity = machine::to_si(f.velocity);
  state.current = machine::to_si(f.current[0]);
  state.dc_link = machine::to_si(protection[0].dc_link);
  state.motor_temperature = 0.1 * protection[0].motor_temperature;
  state.stage_temperature = 0.1 * protection[0].stage_temperature;
  state.torque_off_a = protection[0].torque_off_a;
  state.torque_off_b = protection[0].torque_off_b;
  state.has_dc_link = has.dc_link;
  state.has_motor_temperature = has.motor_temperature;
  state.has_stage_temperature = has.stage_temperature;
  state.has_torque_off = has.torque_off;
  state_.publish();
}

}  // namespace stiction::host
