// A cam on an axis as a result with charts: motion and derivatives, torque of the classic and the electronic cam, the
// spectrum of the acceleration, and the residual oscillation over frequency with the machine's own marked.
#pragma once

#include <vector>

#include "host/cam/axis_load.hpp"
#include "host/cam/duty.hpp"
#include "sim/cam/check.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct CamDesign {
  sim::cam::Motion motion;
  std::vector<sim::cam::MotionJump> jumps;
  AxisLoad load;
  Duty duty;
};

// Figures, findings and charts of `design`: "stiction.cam-design/1".
sim::ExperimentResult design_result(const CamDesign& design);

// Amplitudes of the harmonics 1 to `count` of the acceleration of `motion` over a cycle, in slave units over the square
// of the master's.
std::vector<double> acceleration_harmonics(const sim::cam::Motion& motion, std::size_t count);

}  // namespace stiction::host
