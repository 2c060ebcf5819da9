// Set-points of a log at any time, for a controller that runs faster than the log was written.
//
// Between two samples the motion is the quintic through position, velocity and acceleration at both: where acceleration
// or jerk jump in between, its derivatives swing about them, but leave the machine with the momentum and at the place
// that the log has at the next sample. An acceleration that does not is an error that looks like friction that lags or
// like a delay. Where the way is too coarse for that, or contradicts the velocities (one channel is late), velocity and
// acceleration are derivatives of the cubic through velocity and acceleration alone.
//
// Velocity and acceleration that the log does not have come from x_set: those of the cubic spline through it (twice
// continuously differentiable; where the acceleration jumps it overshoots by 13 % of the jump for one sample). Set
// positions written in coarse steps are smoothed first, by a cubic in a sliding window (A. Savitzky, M. J. E. Golay,
// Anal. Chem. 36, 1964), as wide as it takes for the rounding to leave no more than `acceleration_noise`.
#pragma once

#include <vector>

#include "host/log/log.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::host {

// m/s^2, rms; on 100 kg a newton.
inline constexpr double acceleration_noise = 0.01;

class SetPoints {
 public:
  // Throws LogError when the axis has no x_set.
  SetPoints(const Log& log, const AxisLog& axis);

  // At t (s, on the log's clock). Before the first and behind the last sample the axis rests there.
  sim::AxisSetPoint at(double t) const;

  // At the log's samples.
  const std::vector<double>& position() const { return x_; }      // m; smoothed where smoothing() is not 0
  const std::vector<double>& velocity() const { return v_; }      // m/s
  const std::vector<double>& acceleration() const { return a_; }  // m/s^2

  // Whether the log's own channels were taken. One that contradicts x_set (v_set by more than 2 % of its rms, a_set by
  // more than 20 %, which its jumps may need) is not: it is some other signal of the drive.
  bool velocity_is_logged() const { return velocity_is_logged_; }
  bool acceleration_is_logged() const { return acceleration_is_logged_; }
  double period() const { return period_; }        // s, between samples
  double increment() const { return increment_; }  // m, the grid that x_set is written on; 0: none found
  double smoothing() const { return smoothing_; }  // s, the window's width; 0: not smoothed

 private:
  double beyond_velocity(std::size_t k) const;
  bool way_agrees() const;

  double begin_, period_;
  std::vector<double> x_, v_, a_;
  bool velocity_is_logged_ = false, acceleration_is_logged_ = false, way_agrees_ = false;
  double increment_ = 0.0, smoothing_ = 0.0;
};

}  // namespace stiction::host
