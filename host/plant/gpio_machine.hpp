// A machine behind digital lines, in the kernel's time: the other end of hal/gpio. It plays encoders, index marks,
// switches and fault inputs on a chip of the kernel's gpio-sim, and obeys enable, brake and the duty cycles in a folder
// of the PWM class's shape. Its ticks are not those of the drive: a command acts from its next tick on, an encoder's
// edges are spread evenly over the tick in which they happen.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "host/plant/fault_schedule.hpp"
#include "host/plant/gpio_sim.hpp"
#include "host/plant/plant_under_bus.hpp"
#include "host/plant/pwm_folder.hpp"

namespace stiction::host {

struct GpioMachineConfig {
  struct Axis {
    machine::LineSetup line;
    double increment = 0.0;     // m, from one edge of the tracks to the next
    double start = 0.0;         // m, where the carriage stands
    plant::IndexMarks index{};  // counts of the increment
  };
  std::string chip;           // label or name
  std::filesystem::path pwm;  // made where there is none
  std::int64_t pwm_period_ns = 0;
  double dc_link = 0.0;        // V
  std::int64_t period_ns = 0;  // of a tick
  std::vector<Axis> axes;
};

// As the machine file has them. `marks` and `start` (m): one an axis. Throws plant::GpioSimError where [drive.gpio] or
// a line that has to be there is missing. `machine`: whose increments and axes it has; `setup`: the lines of the
// machine file.
GpioMachineConfig gpio_machine_config(const machine::Machine& machine, const machine::DriveSetup& setup,
                                      std::span<const double> start, std::span<const hal::AxisMarks> marks);

class GpioMachine {
 public:
  // More edges than this in a tick are not played one by one: the tracks take their last level. No kernel's queue holds
  // them, and wires that are connected again do the same.
  static constexpr std::int64_t most_played = 100;

  // `faults` must outlive this. Throws plant::GpioSimError. `config`: lines and PWM folder; `plant`: the machine behind
  // them.
  GpioMachine(const GpioMachineConfig& config, PlantUnderBus plant, const FaultSchedule& faults);

  // Serves until `stop` is true; it is asked each tick.
  void serve(const std::function<bool()>& stop);

  // One tick, which begins at `time_ns` of CLOCK_MONOTONIC; returns when its last edge has been played.
  void tick(std::int64_t time_ns);

  std::int64_t count(std::size_t axis) const { return encoders_[axis].count(); }  // increments
  std::int64_t most_edges() const { return most_edges_; }                         // in a tick, of an axis

 private:
  struct Edge {
    std::int64_t time_ns;
    std::size_t axis;
    bool forward;
  };

  void take_commands();
  void set_switches();
  void plan_edges(std::size_t axis, std::int64_t time_ns);
  bool faulty(LineFaultKind kind, std::size_t axis) const;

  GpioMachineConfig config_;
  PlantUnderBus plant_;
  const FaultSchedule& faults_;
  plant::GpioSim chip_;
  plant::PwmFolder pwm_;
  std::vector<plant::EncoderLines> encoders_;
  std::vector<Edge> edges_;  // of the tick
  std::vector<Command<FixedSignals>> commands_;
  std::vector<Feedback<FixedSignals>> feedback_;
  std::vector<DigitalInputs<FixedSignals>> inputs_;
  std::vector<ProtectionInputs<FixedSignals>> protection_;
  std::uint64_t tick_ = 0;
  std::int64_t most_edges_ = 0;
};

}  // namespace stiction::host
