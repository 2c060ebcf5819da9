// The three systems of equations of the stick-slip feed (Kudoyarov et al., (7), (10), (12)) as one derivative of one
// state. Of the drive's travel x6 the state keeps the wind-up x6 - x7, the small difference on which the forces act.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "firmware/machine/model/feed_drive.hpp"

namespace stiction::sim {

// What moves the near end of the drive's spring.
enum class FeedSource {
  pi_drive,        // the motor with its loops, (7) and (10)
  constant_speed,  // an ideal drive: dx6/dt is the feed
};

// Which form of two faulty equations is solved.
struct FeedEquations {
  // h_c acts on dx6/dt - dx7/dt. As printed it acts on dx6/dt alone: a force that damps nothing.
  bool relative_damping = true;
  // The carriage breaks away when the drive's force C_c (x6 - x7) + h_c (dx6/dt - dx7/dt) reaches static friction and
  // cutting force. As printed, (9), C_c x6 alone has to, which after the first stick is always fulfilled.
  bool relative_stick = true;
};

// x1 .. x8 of the source, then the tool's deflections x9, x10 with their speeds.
namespace feed_state {
enum Index : std::size_t {
  speed_integral,
  current_integral,
  voltage,
  current,
  motor_speed,
  wind_up,
  travel,
  speed,
  tool_x,
  tool_x_speed,
  tool_z,
  tool_z_speed,
  count
};
}  // namespace feed_state
using FeedState = std::array<double, feed_state::count>;

class FeedSystem {
 public:
  // `feed`: speed set-point of the carriage, m/s. `drive`: parameters; `source`: ideal or controlled motor;
  // `equations`: as printed or corrected.
  FeedSystem(const machine::FeedDrive& drive, FeedSource source, FeedEquations equations, double feed)
      : d_(drive),
        source_(source),
        equations_(equations),
        feed_(feed),
        damping_(drive.carriage.damping()),
        per_angle_(drive.lead / (2.0 * std::numbers::pi)) {}

  const machine::FeedDrive& drive() const { return d_; }
  const FeedEquations& equations() const { return equations_; }

  double drive_speed(const FeedState& s) const {
    return source_ == FeedSource::constant_speed ? feed_ : s[feed_state::motor_speed] * per_angle_;
  }
  double drive_travel(const FeedState& s) const { return s[feed_state::wind_up] + s[feed_state::travel]; }
  double spring_force(const FeedState& s) const { return d_.carriage.stiffness * s[feed_state::wind_up]; }
  // Spring and damper, on the carriage.
  double drive_force(const FeedState& s) const {
    const double relative = equations_.relative_damping ? s[feed_state::speed] : 0.0;
    return spring_force(s) + damping_ * (drive_speed(s) - relative);
  }
  // What accelerates the sliding carriage, N.
  double net_force(const FeedState& s) const {
    const double speed = std::max(s[feed_state::speed], 0.0);
    return drive_force(s) - d_.friction.in_motion(speed) - d_.cutting.force(speed);
  }

  // d/dt of the state; `sliding`: system (10), else (7). (12) holds in both.
  FeedState derivative(const FeedState& s, bool sliding) const {
    using namespace feed_state;
    FeedState f{};
    if (source_ == FeedSource::pi_drive) drive_derivative(s, f);
    f[wind_up] = drive_speed(s) - (sliding ? s[speed] : 0.0);
    f[travel] = sliding ? s[speed] : 0.0;
    f[speed] = sliding ? net_force(s) / d_.carriage.mass : 0.0;
    const auto& t = d_.tool;
    const double ratio = sliding ? std::max(s[speed], 0.0) / t.reference_speed : 0.0;
    f[tool_x] = s[tool_x_speed];
    f[tool_x_speed] = tool_acceleration(t.force_x * std::pow(ratio, t.exponent_x), t.stiffness_x, t.damping_ratio_x,
                                        s[tool_x], s[tool_x_speed]);
    f[tool_z] = s[tool_z_speed];
    f[tool_z_speed] = tool_acceleration(t.force_z * std::pow(ratio, t.exponent_z), t.stiffness_z, t.damping_ratio_z,
                                        s[tool_z], s[tool_z_speed]);
    return f;
  }

 private:
  void drive_derivative(const FeedState& s, FeedState& f) const {
    using namespace feed_state;
    const auto& outer = d_.speed_controller;
    const auto& inner = d_.current_controller;
    const double speed_error = outer.feedback * (feed_ / per_angle_ - s[motor_speed]);  // U_3 - K_c x5
    const double current_set = s[speed_integral] + outer.gain * speed_error;            // U_c
    const double current_error = current_set - inner.feedback * s[current];
    const double control = s[current_integral] + inner.gain * current_error;  // U_m
    f[speed_integral] = outer.gain * speed_error / outer.integral_time;
    f[current_integral] = inner.gain * current_error / inner.integral_time;
    f[voltage] = (d_.converter.gain * control - s[voltage]) / d_.converter.time_constant;
    const auto& m = d_.motor;
    f[current] = (s[voltage] - m.torque_constant * s[motor_speed] - m.resistance * s[current]) / m.inductance;
    f[motor_speed] = (m.torque_constant * s[current] - spring_force(s) * per_angle_) / m.inertia;
  }

  double tool_acceleration(double force, double stiffness, double damping_ratio, double deflection,
                           double speed) const {
    const double mass = d_.tool.mass;
    return (force - stiffness * deflection - 2.0 * damping_ratio * std::sqrt(stiffness * mass) * speed) / mass;
  }

  machine::FeedDrive d_;
  FeedSource source_;
  FeedEquations equations_;
  double feed_;
  double damping_;
  double per_angle_;  // m/rad
};

}  // namespace stiction::sim
