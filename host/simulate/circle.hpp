// Runs the circle: the control loop over the simulated machine, set-points from the path, measurement of the lap.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/circle_result.hpp"
#include "sim/machine/machine.hpp"
#include "stiction/drive/axis_signals.hpp"
#include "stiction/drive/faults.hpp"

namespace stiction::host {

// A fault that stopped a run. what() says axis, fault and time.
class FaultTripped : public std::runtime_error {
 public:
  FaultTripped(std::string axis, Fault fault, double time);

  std::string axis;
  Fault fault;
  double time;  // s
};

// A feed that the machine cannot drive, with what was found and expected.
class InfeasibleMotion : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Called for every tick with its time in ns and the signals of every axis.
template <class S>
using TraceSink = std::function<void(std::int64_t, std::span<const AxisSignals<S>>)>;

// Throws InfeasibleMotion when v^2/R, the feed or the radius is beyond what an axis can do.
void check_circle(const sim::Machine& machine, const sim::CircleSettings& settings);

// One circle with the friction models that the machine's axes use. S: FixedSignals or DoubleSignals. Throws
// InfeasibleMotion, FaultTripped, sim::ConfigurationError; the trace sink has had every tick up to the fault.
template <class S>
sim::CircleRun run_circle(const sim::Machine& machine, const sim::CircleSettings& settings,
                          const TraceSink<S>& trace = {});

}  // namespace stiction::host
