// Jerk-limited start along a path (Mendricky 2006, 6.3, Tab 6.2): the acceleration rises with the jerk for t_r,
// stays, and falls again, t_r = a / jerk, t_a = v / a.
#pragma once

#include <algorithm>
#include <cmath>

namespace stiction::sim {

class SpeedRamp {
 public:
  struct Motion {
    double distance;      // m
    double speed;         // m/s
    double acceleration;  // m/s^2
  };

  // From rest to `speed`. Where the speed is reached before the full acceleration, the peak is lower. `speed`: m/s,
  // `acceleration`: m/s^2, `jerk`: m/s^3, all above 0.
  SpeedRamp(double speed, double acceleration, double jerk)
      : speed_(speed),
        jerk_(jerk),
        acceleration_(std::min(acceleration, std::sqrt(speed * jerk))),
        rise_(acceleration_ / jerk),
        end_(speed / acceleration_ + rise_),
        half_way_(0.5 * speed * end_) {}

  double duration() const { return end_; }  // s, until the speed is constant
  double rise() const { return rise_; }     // s, in which the acceleration comes, and goes

  Motion at(double t) const {
    // The ramp is point-symmetric about its middle, so it covers half of speed * duration.
    if (t >= end_) return {half_way_ + speed_ * (t - end_), speed_, 0.0};
    return before_end(t);
  }

 private:
  Motion before_end(double t) const {
    if (t <= rise_) return {jerk_ * t * t * t / 6.0, 0.5 * jerk_ * t * t, jerk_ * t};
    if (t <= end_ - rise_) {
      const double dt = t - rise_;
      const Motion risen = before_end(rise_);
      return {risen.distance + risen.speed * dt + 0.5 * acceleration_ * dt * dt, risen.speed + acceleration_ * dt,
              acceleration_};
    }
    const double rest = end_ - t;
    return {half_way_ - speed_ * rest + jerk_ * rest * rest * rest / 6.0, speed_ - 0.5 * jerk_ * rest * rest,
            jerk_ * rest};
  }

  double speed_;
  double jerk_;
  double acceleration_;
  double rise_;
  double end_;
  double half_way_;  // m, half of speed * duration
};

}  // namespace stiction::sim
