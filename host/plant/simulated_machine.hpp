// The simulated machine behind a bus: the axes' plants, what is broken in them, and what they did after the power was
// taken.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "hal/simulated/faulty_backend.hpp"
#include "hal/simulated/motor_inputs_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "host/plant/fault_schedule.hpp"
#include "host/plant/motion_record.hpp"
#include "host/plant/plant_under_bus.hpp"

namespace stiction::host {

class SimulatedMachine {
 public:
  struct Settings {
    std::vector<double> start;          // m, one an axis
    std::vector<hal::AxisMarks> marks;  // one an axis, or none at all
    std::uint64_t seed = 1;             // of the noise
  };
  // A fault begins to act in this tick.
  using OnFault = std::function<void(const PlantFault&, std::uint64_t tick)>;

  // `machine`: to simulate; `settings`: positions, marks and seed; `faults`: to inject; `on_fault`: called when one
  // begins.
  SimulatedMachine(const machine::Machine& machine, const Settings& settings, FaultSchedule faults,
                   OnFault on_fault = {});

  PlantUnderBus under_bus();  // of this, which must outlive it
  const FaultSchedule& faults() const { return faults_; }
  const sim::AxisPlant& plant(std::size_t axis) const { return simulated_.plant(axis); }
  std::uint64_t ticks() const { return tick_; }

  // How each axis came to rest, a line each (MotionRecord).
  std::vector<std::string> describe() const;

 private:
  void advance(std::span<const Command<FixedSignals>> commands);

  std::vector<std::string> names_;
  std::vector<double> brake_;  // N s/m of a closed brake
  std::vector<char> braked_;
  FaultSchedule faults_;
  OnFault on_fault_;
  hal::SimulatedBackend<FixedSignals> simulated_;
  hal::MotorInputsBackend<hal::SimulatedBackend<FixedSignals>> motors_;
  hal::FaultyBackend<hal::MotorInputsBackend<hal::SimulatedBackend<FixedSignals>>> faulty_;
  std::vector<DigitalInputs<FixedSignals>> halls_;          // of motors_, which know nothing of switches
  std::vector<ProtectionInputs<FixedSignals>> protection_;  // of this tick
  MotionRecord record_;
  std::uint64_t tick_ = 0;
};

}  // namespace stiction::host
