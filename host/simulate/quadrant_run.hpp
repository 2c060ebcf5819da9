// One axis' part of a circle, alone, over several laps: what tuning and proof of the friction compensation measure. A
// circle's axes know nothing of each other unless an effect couples them, so this is half of the work.
#pragma once

#include <cstdint>
#include <vector>

#include "host/simulate/control_run.hpp"
#include "sim/experiment/circle_path.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {

// The machine with this axis alone.
machine::Machine one_axis(const machine::Machine& machine, std::size_t axis);

struct QuadrantRun {
  // m, of each lap, |x_set - x| at the encoder, unquantised. Laps begin between two quadrants; the first one, with the
  // start in it, begins an eighth of a turn after it.
  std::vector<double> peak_error;
  double peak_current = 0.0;                              // A, over all laps
  bool dropped = false;                                   // the learned table was dropped
  std::vector<double> learned_forward, learned_backward;  // A
};

// Noise of the current's sensors, as it acts: a reading that is too high by some amperes takes as many from the motor,
// so it is put on the set current.
struct CurrentNoise {
  double rms = 0.0;  // A
  std::uint64_t seed = 1;
};

// Throws InfeasibleMotion where the circle is beyond the axis, FaultTripped, sim::ConfigurationError. `machine`: of
// which the `axis` (index) runs alone; `settings`: the circle; `laps`: at least 1; `trace`: sees every tick; `noise`:
// on the current.
QuadrantRun run_quadrants(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& settings,
                          int laps, const TraceSink<FixedSignals>& trace = {}, const CurrentNoise& noise = {});

}  // namespace stiction::host
