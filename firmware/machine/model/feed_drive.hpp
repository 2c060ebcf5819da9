// A feed drive with screw, sliding carriage, cutting and tool, as R. G. Kudoyarov et al. describe it (systems (7), (10)
// and (12) of the source; it prints no parameters). SI units; every quantity is described in
// firmware/machine/file/feed_drive_parameters.hpp.
#pragma once

#include <cmath>
#include <numbers>

namespace stiction::machine {

struct FeedMotor {
  double torque_constant = 0.0;  // C, N m/A and V s/rad
  double resistance = 0.0;       // R, Ohm
  double inductance = 0.0;       // L, H
  double inertia = 0.0;          // J, kg m^2
};

struct FeedConverter {
  double gain = 0.0;           // K_n
  double time_constant = 0.0;  // tau, s
};

// U = x + K e, T dx/dt = K e, e = set-point - feedback * measured.
struct FeedController {
  double gain = 0.0;           // K_pc, K_pm
  double integral_time = 0.0;  // T_pc, T_pm, s
  double feedback = 0.0;       // K_c, V s/rad, or K_m, V/A
};
struct FeedSpeedController : FeedController {};
struct FeedCurrentController : FeedController {};

struct FeedCarriage {
  double mass = 0.0;           // m, kg
  double stiffness = 0.0;      // C_c, N/m
  double damping_ratio = 0.0;  // h_c = 2 damping_ratio sqrt(C_c m)

  double natural_frequency() const { return std::sqrt(stiffness / mass); }  // rad/s
  double damping() const { return 2.0 * damping_ratio * std::sqrt(stiffness * mass); }
};

// (4), (5): force = load * coefficient. At standstill the coefficient grows from `static_short` to `static_long` with
// the dwell time, in motion it falls from `static_short` to `sliding` over the Stribeck velocity, at once when that is
// zero.
struct FeedFriction {
  double normal_load = 0.0;  // N, N
  double static_short = 0.0;
  double static_long = 0.0;
  double dwell_time = 0.0;  // s
  double sliding = 0.0;
  double stribeck_velocity = 0.0;  // m/s
  double viscous = 0.0;            // N s/m

  double at_rest(double dwell) const {
    return normal_load * (static_long + (static_short - static_long) * std::exp(-dwell / dwell_time));
  }
  double in_motion(double speed) const {
    const double drop =
        stribeck_velocity > 0.0 ? (static_short - sliding) * std::exp(-std::pow(speed / stribeck_velocity, 2.0)) : 0.0;
    return normal_load * (sliding + drop) + viscous * speed;
  }
  // The step of friction after a long standstill, N.
  double step() const { return normal_load * (static_long - sliding); }
};

// (6): force = constant_force + coefficient * feed per revolution.
struct FeedCutting {
  double constant_force = 0.0;  // P_R, N
  double coefficient = 0.0;     // C_v0, N per m of feed per revolution
  double spindle_speed = 0.0;   // rad/s

  double revolution() const { return 2.0 * std::numbers::pi / spindle_speed; }  // s
  double force(double speed) const { return constant_force + coefficient * speed * revolution(); }
};

// (12), the force C* x8^y given by its value at a speed.
struct FeedTool {
  double mass = 0.0;                            // m_p, kg
  double stiffness_x = 0.0, stiffness_z = 0.0;  // N/m
  double damping_ratio_x = 0.0, damping_ratio_z = 0.0;
  double reference_speed = 0.0;         // m/s
  double force_x = 0.0, force_z = 0.0;  // N, at the reference speed
  double exponent_x = 0.0, exponent_z = 0.0;
};

struct FeedDrive {
  double lead = 0.0;  // h, m per turn
  FeedMotor motor;
  FeedConverter converter;
  FeedSpeedController speed_controller;
  FeedCurrentController current_controller;
  FeedCarriage carriage;
  FeedFriction friction;
  FeedCutting cutting;
  FeedTool tool;
};

}  // namespace stiction::machine
