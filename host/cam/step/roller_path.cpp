#include "host/cam/step/roller_path.hpp"

#include <cmath>

namespace stiction::host::step {

RollerPoint roller_at(const StepMechanism& mechanism, double base, double psi, const LiftState& lift) {
  const double sense = mechanism.against ? -1.0 : 1.0;
  const double a = mechanism.axis_distance, b = mechanism.arm;
  RollerPoint p;
  p.arm_angle = base + sense * lift.way;
  p.arm_speed = sense * lift.speed;
  const double bend = sense * lift.acceleration;
  const Point turned = sim::in_direction(1.0, psi), arm = sim::in_direction(b, -p.arm_angle), i(0.0, 1.0);
  p.centre = turned * (a - arm);
  p.rate = i * turned * (a - (1.0 - p.arm_speed) * arm);
  const Point second =
      -turned * (a - (1.0 - p.arm_speed) * arm) + i * turned * arm * Point(bend, (1.0 - p.arm_speed) * p.arm_speed);
  const double speed = sim::magnitude(p.rate);
  p.normal = i * p.rate / speed;
  p.curvature = cross(p.rate, second) / (speed * speed * speed);
  p.turning = cross(p.centre, p.rate) / std::norm(p.centre);
  return p;
}

}  // namespace stiction::host::step
