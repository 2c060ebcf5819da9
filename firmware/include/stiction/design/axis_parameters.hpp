// The groups of an axis' parameters in SI units, under the names that they have in a machine file. Positions are the
// carriage's; a current is the amplitude of the whole motor's; zero means "left out" where a comment says so.
#pragma once

#include "stiction/control/velocity_estimator.hpp"
#include "stiction/drive/axis.hpp"

namespace stiction::design {

// Whether a loop has the three phases of a synchronous motor.
constexpr bool has_phases(CurrentLoop loop) {
  return loop == CurrentLoop::three_phase || loop == CurrentLoop::three_phase_offset;
}

struct TimingParameters {
  double fast_period = 62.5e-6;  // s: current and velocity controllers, feedforwards
  double slow_period = 1e-3;     // s: position controller
};

struct MotorParameters {
  CurrentLoop loop =
      CurrentLoop::direct;       // three_phase(_offset): synchronous motor; direct: DC motor; none: force source
  double force_constant = 0.0;   // N/A of the whole motor, amplitude amperes; N/V of a force source
  double pole_pair_pitch = 0.0;  // m; of a synchronous motor
  int count = 1;                 // motors in parallel on one servo module
};

struct InverterParameters {
  double voltage_limit = 0.0;  // V
  double current_limit = 0.0;  // A per motor; a force source is limited by its voltage
};

struct EncoderParameters {
  VelocityFeedback velocity = VelocityFeedback::difference;
};

struct PositionControllerParameters {
  double gain = 0.0;       // 1/s
  double increment = 0.0;  // m, of the position error's quantizer; 0: none
};

// Velocity controller: gain in A s/m, V s/m of a force source. Current controller: V/A; a force source has none.
struct PiParameters {
  double gain = 0.0;
  double integral_time = 0.0;  // s; 0: proportional only
};

struct NotchParameters {
  double frequency = 0.0;            // Hz; 0: no notch
  double numerator_damping = 0.0;    // depth, 0 is deepest
  double denominator_damping = 0.0;  // width
};

struct FeedforwardParameters {
  double velocity = 0.0;  // 1: full
  double current = 0.0;   // of mass * acceleration / force constant; 1: full
};

inline constexpr double default_following_error = 2e-3;  // m

// Limits whose violation is a fault (the motion stops), unlike the limits of inverter and axis, which only limit.
struct SupervisionParameters {
  double following_error = 0.0;  // m; 0: default_following_error
  double over_current = 0.0;     // A of the whole axis; 0: 1.2 times the current limit
  double over_speed = 0.0;       // m/s; 0: 1.2 times max_velocity
};

// A of the whole axis, V of a force source.
constexpr double largest_current(const MotorParameters& motor, const InverterParameters& inverter) {
  return motor.loop == CurrentLoop::none ? inverter.voltage_limit : inverter.current_limit * motor.count;
}

}  // namespace stiction::design
