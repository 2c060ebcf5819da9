// The polynomials through given position, speed, acceleration and jerk at both ends of [0, 1] (Hermite's;
// coefficients from the linear equations of the end at 1).
#pragma once

#include <vector>

namespace stiction::sim::cam {

struct EndState {
  double position = 0.0;
  double speed = 0.0;         // slave units over master units
  double acceleration = 0.0;  // over their square
  double jerk = 0.0;

  // Seen from the other end: the master runs backwards.
  EndState reversed() const { return {position, -speed, acceleration, -jerk}; }
};

// Coefficients of t^0 to t^5 through position, speed and acceleration of `start` at 0 and of `end` at 1.
inline std::vector<double> quintic(const EndState& start, const EndState& end) {
  const double a = 0.5 * start.acceleration;
  const double rise = (end.position - start.position) - start.speed - a;
  const double speed = end.speed - start.speed - 2.0 * a;
  const double bend = 0.5 * (end.acceleration - start.acceleration);
  return {start.position,
          start.speed,
          a,
          10.0 * rise - 4.0 * speed + bend,
          -15.0 * rise + 7.0 * speed - 2.0 * bend,
          6.0 * rise - 3.0 * speed + bend};
}

// Coefficients of t^0 to t^7 through position, speed, acceleration and jerk of `start` at 0 and of `end` at 1.
inline std::vector<double> septic(const EndState& start, const EndState& end) {
  const double a = 0.5 * start.acceleration, j = start.jerk / 6.0;
  const double rise = (end.position - start.position) - start.speed - a - j;
  const double speed = end.speed - start.speed - 2.0 * a - 3.0 * j;
  const double bend = 0.5 * (end.acceleration - start.acceleration) - 3.0 * j;
  const double twist = (end.jerk - start.jerk) / 6.0;
  return {start.position,
          start.speed,
          a,
          j,
          35.0 * rise - 15.0 * speed + 5.0 * bend - twist,
          -84.0 * rise + 39.0 * speed - 14.0 * bend + 3.0 * twist,
          70.0 * rise - 34.0 * speed + 13.0 * bend - 3.0 * twist,
          -20.0 * rise + 10.0 * speed - 4.0 * bend + twist};
}

}  // namespace stiction::sim::cam
