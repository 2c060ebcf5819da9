// Where a motion jumps: position, speed, acceleration and jerk at every joint of every law, where segments meet, and
// over the seam of a periodic cam.
#pragma once

#include <vector>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

enum class JumpPlace {
  inside,  // at a joint of the law of a segment
  joint,   // where two segments meet
  seam,    // from the end of a periodic cam to its start
  ends     // where a cam that runs once starts or ends and is not at rest
};

struct MotionJump {
  Jump jump;  // at the master's place; of the seam at its end
  JumpPlace where;
  std::size_t segment;  // that ends there, or that it is inside of
  double share;         // of the largest value of that derivative
};

// A step is a jump from this share of the peak of its derivative on: a thousand times the rounding of a composed
// motion, and a tenth of what anybody plans.
inline constexpr double jump_tolerance = 1e-7;

// All jumps of `motion` of the derivatives 0 to 3, in the order of the master and of the derivatives. `tolerance`: of
// the peak of each derivative; of the position, of the whole range of it.
std::vector<MotionJump> jumps_of(const Motion& motion, double tolerance = jump_tolerance);

// "position", "speed", "acceleration", "jerk" of the derivative of `order`; the name of a place.
std::string_view derivative_name(int order);
std::string_view name_of(JumpPlace place);

}  // namespace stiction::sim::cam
