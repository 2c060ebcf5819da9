// The controllers of an axis that are not the firmware's cascade, in double precision: P on voltage, PD and PID on
// voltage or on current with its PI controllers (Astrom, Hagglund 2006, chapters 3 and 13).
//
// In a sample the integral takes the new error before it is used, and keeps its value where the output is limited. The
// derivative acts on the velocity error and is not multiplied by the gain.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/set_point.hpp"
#include "sim/plant/motor.hpp"

namespace stiction::host {

class StructuredAxis {
 public:
  // What the drive sees in one tick, in SI units.
  struct Seen {
    double position;                         // of the position controller's encoder
    std::optional<double> velocity_encoder;  // position of the velocity loop's; none: the same
    double velocity;                         // as the machine file says that it is measured
    sim::PhaseValues current;                // of the windings
  };
  struct Command {
    double output = 0.0;         // A or V, of the structure
    sim::PhaseValues voltage{};  // of the windings, or the command of an ideal source
    double current = 0.0;        // A, amplitude of what flows
  };

  // Of an `axis` with a structure that is not the cascade and not unknown. `timing`: of its machine.
  StructuredAxis(const machine::Timing& timing, const machine::AxisModel& axis);

  // One fast tick.
  Command tick(const sim::AxisSetPoint& set, const Seen& seen);

 private:
  // gain (1 + 1/(T s)) of an error, with `step` = period/T; 0: no integral.
  struct ProportionalIntegral {
    double gain = 0.0, step = 0.0, sum = 0.0;
    double advance(double error, double added, double limit);
  };

  double speed(const Seen& seen);

  machine::ControlStructure structure_;
  machine::VelocitySource source_;
  std::int64_t ticks_per_period_;
  double period_;
  double derivative_;
  double limit_;
  double voltage_limit_;
  double pitch_;       // m of a pole pair; 0: one winding
  bool current_loop_;  // the output is a current that controllers make
  bool electrical_;
  ProportionalIntegral law_;
  std::array<ProportionalIntegral, 3> current_laws_;
  std::int64_t tick_ = 0;
  double held_ = 0.0;  // of the structure, over its period
  std::optional<double> last_, mean_;
};

}  // namespace stiction::host
