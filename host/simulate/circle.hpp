// Runs the circle: the control loop over the simulated machine, set-points from the path, measurement of the lap.
#pragma once

#include <stdexcept>

#include "firmware/machine/model/machine.hpp"
#include "host/simulate/control_run.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// A feed that the machine cannot drive, with what was found and expected.
class InfeasibleMotion : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws InfeasibleMotion when v^2/R, the feed or the radius is beyond what an axis can do.
void check_circle(const machine::Machine& machine, const sim::CircleSettings& settings);

// One circle with the friction models that the machine's axes use. S: FixedSignals or DoubleSignals. Throws
// InfeasibleMotion, FaultTripped, sim::ConfigurationError; the trace sink has had every tick up to the fault.
// `machine`: of two axes; `settings`: radius, feed and direction.
template <class S>
sim::CircleRun run_circle(const machine::Machine& machine, const sim::CircleSettings& settings,
                          const TraceSink<S>& trace = {});

}  // namespace stiction::host
