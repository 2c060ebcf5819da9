#include "host/plant/simulated_machine.hpp"

#include <algorithm>
#include <utility>

#include "firmware/machine/configuration/axis_configuration.hpp"

namespace stiction::host {

SimulatedMachine::SimulatedMachine(const machine::Machine& machine, const Settings& settings, FaultSchedule faults,
                                   OnFault on_fault)
    : braked_(machine.axes.size()),
      faults_(std::move(faults)),
      on_fault_(std::move(on_fault)),
      simulated_(machine, settings.start, settings.seed),
      motors_(simulated_, machine),
      faulty_(motors_, machine::fast_period_ns(machine.timing), machine.axes.front().encoder.increment),
      halls_(machine.axes.size()),
      protection_(machine.axes.size()),
      record_(machine.axes.size()) {
  for (const auto& axis : machine.axes) {
    names_.push_back(axis.name);
    // Halves the speed in a tick: the force is that at the tick's begin.
    brake_.push_back(axis.mass / (2.0 * machine.timing.fast_period));
  }
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    motors_.signals(i).hall_wired = machine.axes[i].motor.model == machine::MotorModel::synchronous;
  for (std::size_t i = 0; i < settings.marks.size(); ++i) faulty_.marks(i) = settings.marks[i];
  faulty_.wait_for_tick();  // the start
  motors_.read_protection(protection_);
}

PlantUnderBus SimulatedMachine::under_bus() {
  return {
      .advance = [this](auto commands) { advance(commands); },
      .sample =
          [this](auto feedback, auto inputs) {
            faulty_.read(feedback);
            faulty_.read_inputs(inputs);
            motors_.read_inputs(halls_);
            for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].hall = halls_[i].hall;
          },
      .sample_protection = [this](auto inputs) { std::copy(protection_.begin(), protection_.end(), inputs.begin()); },
      .motor_signals = [this](std::size_t axis) { return motors_.motor_signals(axis); },
      .set_brake = [this](std::size_t axis, bool closed) { braked_[axis] = closed ? 1 : 0; }};
}

void SimulatedMachine::advance(std::span<const Command<FixedSignals>> commands) {
  const std::uint64_t to_come = tick_ + 1;  // whose sample shows what is broken
  faults_.advance(to_come);
  faults_.break_parts(
      to_come, [&](std::size_t axis) -> hal::AxisFaults& { return faulty_.faults(axis); },
      [&](std::size_t axis) -> hal::MotorSignals& { return motors_.signals(axis); });
  for (const auto& fault : faults_.faults())
    if (on_fault_ && fault.acts(to_come) && (tick_ == 0 || !fault.acts(tick_))) on_fault_(fault, to_come);
  for (std::size_t i = 0; i < braked_.size(); ++i) {
    auto& plant = simulated_.plant(i);
    plant.set_external_force(braked_[i] != 0 ? -brake_[i] * plant.velocity() : 0.0);
  }
  faulty_.write(commands);
  faulty_.wait_for_tick();
  motors_.read_protection(protection_);
  tick_ = to_come;
  for (std::size_t i = 0; i < commands.size(); ++i) record_.add(i, commands[i].enable, simulated_.plant(i).position());
}

std::vector<std::string> SimulatedMachine::describe() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < names_.size(); ++i) lines.push_back(record_.describe(names_[i], i));
  return lines;
}

}  // namespace stiction::host
