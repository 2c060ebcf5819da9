// Runs the circle: the control loop over the simulated machine, set-points from the path, measurement of the lap. A
// machine with one axis drives a sine in its place, with the radius as amplitude and with the frequency of the circle.
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

// Throws InfeasibleMotion when v^2/R, the feed or the radius is beyond what the axis can do.
void check_circle(const machine::AxisModel& axis, const sim::CircleSettings& settings);
// The same of all axes, one or two, and for a lap of less than eight periods of the position controller.
void check_circle(const machine::Machine& machine, const sim::CircleSettings& settings);

// Where nobody gives a value: the radius (m) of the source's circle, 90 mm, or less where the travel of an axis is
// short; the highest feed (m/s) on this `radius` that every axis can drive with a tenth of its limits in reserve; and
// the feed of the source, 16 m/min, or one of its slower ones, or a tenth, a hundredth of them.
double usual_radius(const machine::Machine& machine);
double highest_feed(const machine::Machine& machine, double radius);
double usual_feed(const machine::Machine& machine, double radius);

// A counter-clockwise circle with `feed` (m/s) and `radius` (m). Its start is as quick as that of the source, or as
// quick as every axis of `machine` can drive.
sim::CircleSettings circle_settings(const machine::Machine& machine, double feed, double radius);

// One circle with the friction models that the machine's axes use. S: FixedSignals or DoubleSignals. Throws
// InfeasibleMotion, FaultTripped, sim::ConfigurationError; the trace sink has had every tick up to the fault.
// `machine`: of one or two axes; `settings`: radius, feed and direction.
template <class S>
sim::CircleRun run_circle(const machine::Machine& machine, const sim::CircleSettings& settings,
                          const TraceSink<S>& trace = {});

}  // namespace stiction::host
