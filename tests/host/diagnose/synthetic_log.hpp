// Logs by simple arithmetic, without the plant's code: force = m a + LuGre's contact + what the test hides, along a
// designed motion, with coloured noise on the force and the rounding of an encoder on the position.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::test {

// The machine of the tests: one axis, force from amplitude amperes, LuGre friction.
machine::Machine bench_machine();

struct Point {
  double t, x, v, a;  // s, m, m/s, m/s^2
  double level;       // of the contact, -1 to 1
};

struct Hidden {
  double mass = 225.0, coulomb = 90.0, viscous = 500.0;  // kg, N, N s/m: true values
  double contact_length = 90.0 / 8e5;                    // m
  double other_share = 0.0, other_length = 1.0;          // m: of Coulomb friction, with a contact of its own length
  std::function<double(const Point&)> force{};           // N, what the motor must give besides; none: nothing
  double delay = 0.0;                                    // s, of the recorded current
  double lost_motion = 0.0;                              // m
  double force_constant = 94.0;                          // N/A, true value
  double saturation_current = 0.0;                       // A; 0: none
  double other_mass = 0.0;                               // kg: the other axis' acceleration pushes towards +x
  double friction_lag = 0.0;                             // s, of viscous friction
  std::function<double(double)> constant_ripple{};       // share of the motor's force, over x (m)
  std::function<double(double)> reading_error{};         // m, of the encoder over x (m)
};

// `trajectory` 0, 1, 2: constant speeds both ways, sines of several periods, steps of several lengths. The log has a
// second axis, which swings on its own.
host::Log synthetic_log(int trajectory, const Hidden& hidden, double noise_rms, std::uint64_t seed);

}  // namespace stiction::test
