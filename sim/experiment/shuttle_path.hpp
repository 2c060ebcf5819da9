// One axis to and fro at constant speed: passes between two ends, each from rest to rest with a jerk-limited start and
// stop (speed_ramp.hpp), in alternating direction. What is measured in the middle of a pass never meets a reversal.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/experiment/set_point.hpp"
#include "sim/experiment/speed_ramp.hpp"

namespace stiction::sim {

class ShuttlePath {
 public:
  // `cruise` (s): how long a pass has its full `speed` (m/s). `acceleration`, `jerk`: of each turn, m/s^2 and m/s^3,
  // above 0.
  ShuttlePath(double speed, double acceleration, double jerk, double cruise)
      : ramp_(speed, acceleration, jerk), cruise_(cruise), stroke_(speed * (ramp_.duration() + cruise)) {}

  double pass_duration() const { return 2.0 * ramp_.duration() + cruise_; }  // s
  double cruise_begin() const { return ramp_.duration(); }                   // s after the start of a pass
  double stroke() const { return stroke_; }                                  // m, between the two ends

  AxisSetPoint at(double t) const {
    const double passes = std::floor(t / pass_duration());
    const bool back = std::fmod(passes, 2.0) != 0.0;
    const auto there = in_pass(t - passes * pass_duration());
    if (!back) return there;
    return {stroke_ - there.position, -there.velocity, -there.acceleration};
  }

 private:
  AxisSetPoint in_pass(double t) const {
    const double stop = ramp_.duration() + cruise_;
    if (t <= stop) {
      const auto motion = ramp_.at(t);
      return {motion.distance, motion.speed, motion.acceleration};
    }
    const auto motion = ramp_.at(std::max(pass_duration() - t, 0.0));  // the start, backwards
    return {stroke_ - motion.distance, motion.speed, -motion.acceleration};
  }

  SpeedRamp ramp_;
  double cruise_;
  double stroke_;
};

}  // namespace stiction::sim
