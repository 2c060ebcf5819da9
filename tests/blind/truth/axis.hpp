// The truth: one axis of a cross table in closed loop with the firmware's control. Motor, carriage, friction, encoder,
// noise and effects are its own; only the control law and its configuration are those under test.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "tests/blind/truth/contact.hpp"
#include "tests/blind/truth/noise.hpp"
#include "tests/blind/truth/trajectory.hpp"

namespace stiction::blind {

// The mechanics, with everything that may be hidden in them; by default nothing is. Forces on the carriage, positive in
// +x; friction positive against +v.
struct Mechanics {
  double mass = 0.0;
  double viscous = 0.0;
  std::vector<ContactElement> contact;

  double rise = 0.0, rise_velocity = 1.0;                 // N, m/s: friction above the line, 1 - e^(-|v|/V)
  double break_away = 0.0, stribeck_velocity = 1.0;       // N, m/s
  double more_in_plus = 0.0, more_viscous_in_plus = 0.0;  // N, N s/m
  double constant_force = 0.0;
  double spring = 0.0, spring_neutral = 0.0;  // N/m, m
  double ripple_pitch = 1.0;
  std::vector<double> ripple_cosine, ripple_sine;                    // N, of the harmonics
  double backlash = 0.0;                                             // m, between carriage and encoder
  double current_delay = 0.0;                                        // s, of the current's record
  double force_ratio = 1.0;                                          // true force constant over the file's
  double saturation_current = 0.0;                                   // A; 0: none
  double mode_frequency = 0.0, mode_damping = 0.0, mode_load = 0.5;  // Hz (0: none), ratio, share of the mass
  double other_mass = 0.0;                                           // kg: the other axis' acceleration as force
  // Of the file: N/A, 1/s, A s/m, s.
  double force_constant = 0.0;
  double file_position_gain = 0.0, file_velocity_gain = 0.0, file_velocity_integral_time = 0.0;
  // True gains and integral times of the drive over the file's.
  double position_gain = 1.0, velocity_gain = 1.0, velocity_integral_time = 1.0;

  double friction_lag = 0.0;                            // s, viscous friction after the speed
  std::vector<double> profile_position, profile_force;  // m, N: more friction there, linear between
  double drift = 0.0, drift_time = 1.0;                 // N, s: friction's level, 1 - e^(-t/T) from a log's start
  double constant_ripple_pitch = 1.0;                   // m
  double constant_cosine = 0.0, constant_sine = 0.0;    // share of the motor's force
  double reading_period = 1.0;                          // m
  double reading_cosine = 0.0, reading_sine = 0.0;      // m, of the encoder's error
  double tone_frequency = 1.0;                          // Hz
  double tone_cosine = 0.0, tone_sine = 0.0;            // N, in the first log; the phase differs from log to log

  // Outside of the vocabulary.
  double bump = 0.0, bump_position = 0.0, bump_width = 1.0;  // N, m, m: a push at one place
  double speed_ripple = 0.0, speed_ripple_pitch = 1.0;       // N s/m, m: periodic in position, grows with speed
  double kick = 0.0, kick_time = 1.0;                        // N, s: pushes forward after each reversal and dies away
};

struct Tripped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Runs `trajectory` and records x_set, x, i every `period` s, a multiple of the fast period. One axis: the machine's
// first, whose motor, encoder, inverter and control are taken from `machine`; beside it the record has the position of
// a second one, Y, which follows `other` without any error. Throws Tripped when the drive trips. The last two
// digits of the seed number the record: phases that differ from log to log follow them.
host::Log record(const machine::Machine& machine, const Mechanics& mechanics, const Trajectory& trajectory,
                 const Trajectory& other, const NoiseLevels& noise, double period, std::uint64_t seed);

// Residual force of a record against `mechanics` (its mass, viscous friction and contact alone), N, zero-phase 0 to
// `band` Hz; the band's settling at both ends is cut off.
std::vector<double> residual_force(const host::Log& log, const Mechanics& mechanics, double force_constant,
                                   double band = 100.0);

// Butterworth of second order, forwards and backwards: no phase, -6 dB at the corner (Hz).
void zero_phase(std::vector<double>& values, double corner, double period);

}  // namespace stiction::blind
