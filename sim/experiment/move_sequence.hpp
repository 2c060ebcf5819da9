// Moves of one axis from rest to rest, one after another, each with a jerk-limited start and stop (speed_ramp.hpp).
#pragma once

#include <vector>

#include "sim/experiment/set_point.hpp"
#include "sim/experiment/speed_ramp.hpp"

namespace stiction::sim {

// How a move starts and stops.
struct Dynamics {
  double acceleration;  // m/s^2
  double jerk;          // m/s^3
};

class MoveSequence {
 public:
  explicit MoveSequence(double start = 0.0) : start_(start), place_(start) {}

  // Rests for `duration` s.
  void rest(double duration) { time_ += duration; }
  // Moves with the full `speed` (m/s) for `cruise` s; towards -x where the speed is negative. `dynamics`: acceleration
  // and jerk.
  void pass(double speed, double cruise, const Dynamics& dynamics);
  // Moves by `distance` (m, signed) at `speed` (m/s, positive), or as fast as the distance allows. `dynamics`:
  // acceleration and jerk.
  void move(double distance, double speed, const Dynamics& dynamics);

  double duration() const { return time_; }  // s
  double place() const { return place_; }    // m, where it has come to
  // Of the last move: when its speed is constant, s.
  double cruise_begin() const { return moves_.back().begin + moves_.back().ramp.duration(); }
  double cruise_end() const { return cruise_begin() + moves_.back().cruise; }

  AxisSetPoint at(double t) const;

 private:
  struct Move {
    SpeedRamp ramp;
    double speed, cruise, sign, from, begin;
    double duration() const { return 2.0 * ramp.duration() + cruise; }
    double distance() const { return speed * (ramp.duration() + cruise); }
    AxisSetPoint at(double t) const;
  };

  double start_, place_, time_ = 0.0;
  std::vector<Move> moves_;
};

// The highest speed, at most `speed` (m/s), that a move over `distance` (m) holds for at least `cruise` s. `dynamics`:
// acceleration and jerk of the move.
double speed_within(double distance, double speed, double cruise, const Dynamics& dynamics);

}  // namespace stiction::sim
