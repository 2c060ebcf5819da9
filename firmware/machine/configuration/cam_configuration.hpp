// From a machine file's axis and the speed of a master to the configuration of the firmware's cam: limits in units of
// the tick. The drive's programme and the simulation have it from here, so that both make the same set-points.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "stiction/motion/cam_motion.hpp"
#include "stiction/motion/cam_table.hpp"
#include "stiction/motion/master.hpp"

namespace stiction::machine {

// Magnitudes of a motion: of a slave in m, of a master in cycles, over s.
struct MotionBounds {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
};

// `bounds` in the formats of the firmware, held to what those take. `period`: of the tick, s.
MotionLimits motion_limits(const MotionBounds& bounds, double period);
// The same back.
MotionBounds motion_bounds(const MotionLimits& limits, double period);

// What a virtual master keeps that runs at up to `speed`, cycles/s: it comes to that speed within about one cycle.
MotionBounds master_bounds(double speed);
// What an axis keeps that follows a cam: its own limits of speed and acceleration, and the jerk that brings the
// acceleration up within a period of the position controller. `timing`, `axis`: of the machine file.
MotionBounds cam_bounds(const Timing& timing, const AxisModel& axis);
// `speed`, cycles/s, as VirtualMaster::run() takes it. `period`: of the tick, s.
std::int64_t master_speed(double speed, double period);

// What is wrong where a curve asks for more than the axis keeps: "found ...; expected ...". `curve`: as prepared, in m;
// `config`: of the axis; `period`: of the tick, s; `factor`, `unit`: of the slave's unit, for m.
std::string words_of_limits(const CamCurve& curve, const CamMotion::Config& config, double period, double factor = 1.0,
                            const std::string& unit = "m");

}  // namespace stiction::machine
