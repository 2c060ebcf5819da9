// Motors: windings with resistance, inductance and back EMF under the inverter's voltage (Mendricky 2006, 3.1-3.14).
// Each winding takes the exact step of its R-L equation for voltage and EMF held over the step.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "firmware/machine/model/machine.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim {

using PhaseValues = std::array<double, 3>;

// Exact step of L di/dt = u - R i.
class Winding {
 public:
  // `resistance`: Ohm, `inductance`: H, `step`: s, all above 0.
  Winding(double resistance, double inductance, double step)
      : decay_(std::exp(-resistance * step / inductance)), gain_((1.0 - decay_) / resistance) {}

  // Current (A) one step later under the voltage `u` (V) across R and L.
  double advance(double current, double u) const { return decay_ * current + gain_ * u; }
  double decay() const { return decay_; }
  double gain() const { return gain_; }  // A per V in a step

 private:
  double decay_;
  double gain_;
};

// DC equivalent of the synchronous motor: R, L, K_E of one winding, K_F of the whole motor (3.14). `count` motors in
// parallel: the current is their sum, R and L are divided.
class DcMotor {
 public:
  static constexpr std::size_t phases = 1;

  DcMotor(const machine::MotorParameters& motor, double step)
      : winding_(motor.phase_resistance / motor.count, motor.phase_inductance / motor.count, step),
        gain_(0.5 * motor.force_constant * winding_.gain()),
        emf_gain_(gain_ * motor.emf_constant),
        amperes_(2.0 / motor.force_constant) {}

  // Moves the current on by one step at velocity v (m/s); returns the mean force (N) over the step. What the voltage
  // adds is a term of its own, the same in every step that it is held. `voltage`: of the phases, of which the first is
  // used. The position, the double without a name, has no effect.
  double advance(const PhaseValues& voltage, double, double v) {
    const double before = half_force_;
    half_force_ = winding_.decay() * before + gain_ * voltage[0] - emf_gain_ * v;
    return before + half_force_;
  }
  PhaseValues current() const { return {amperes_ * half_force_}; }
  void switch_off() { half_force_ = 0.0; }

 private:
  Winding winding_;
  double gain_;              // N per V in a step, of half the force
  double emf_gain_;          // N per m/s in a step, of half the force
  double amperes_;           // A per N of half the force
  double half_force_ = 0.0;  // N, in place of the current: a step costs a product less
};

// Three-phase synchronous linear motor (3.7-3.12) with a star point: its currents sum to zero, so that the mutual
// inductance only lowers the effective one, L - M, and the mean of the phase voltages has no effect.
class SynchronousMotor {
 public:
  static constexpr std::size_t phases = 3;

  // `motor`: windings and constants; `step`: of the plant, s; `offset`: rad, electrical angle at position zero.
  SynchronousMotor(const machine::MotorParameters& motor, double step, double offset = 0.0)
      : winding_(motor.phase_resistance / motor.count, (motor.phase_inductance - motor.mutual_inductance) / motor.count,
                 step),
        emf_constant_(motor.emf_constant),
        half_force_constant_(0.5 * motor.phase_force_constant),
        angle_per_metre_(2.0 * std::numbers::pi / motor.pole_pair_pitch),
        half_step_(0.5 * step),
        offset_(offset) {}

  // Moves the currents on by one step from position x (m) at velocity v (m/s); returns the mean force (N). `voltage`:
  // of the three phases, V.
  double advance(const PhaseValues& voltage, double x, double v) {
    const double angle = angle_per_metre_ * (x + half_step_ * v) + offset_;
    const auto [s, c] = sine_cosine(angle);
    constexpr double half_root_3 = 0.5 * std::numbers::sqrt3;
    const PhaseValues sine{s, -0.5 * s + half_root_3 * c, -0.5 * s - half_root_3 * c};
    const double star = (voltage[0] + voltage[1] + voltage[2]) / 3.0;
    double force = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double before = current_[k];
      current_[k] = winding_.advance(before, voltage[k] - star - emf_constant_ * v * sine[k]);
      force += (before + current_[k]) * sine[k];
    }
    return half_force_constant_ * force;
  }
  const PhaseValues& current() const { return current_; }
  void switch_off() { current_ = {}; }

 private:
  Winding winding_;
  double emf_constant_;
  double half_force_constant_;
  double angle_per_metre_;
  double half_step_;
  double offset_;
  PhaseValues current_{};
};

// A motor whose power stage is off.
struct OpenWindings {
  // Neither the PhaseValues nor position and velocity, both double, have an effect.
  double advance(const PhaseValues&, double, double) { return 0.0; }
};

// Ideal force source driven by a voltage command, N/V.
class ForceSource {
 public:
  static constexpr std::size_t phases = 1;

  ForceSource(const machine::MotorParameters& motor, double) : force_constant_(motor.force_constant) {}

  // Returns the force, N, of a `voltage`; position and velocity, both double, have no effect.
  double advance(const PhaseValues& voltage, double, double) {
    current_[0] = voltage[0];
    return force_constant_ * voltage[0];
  }
  const PhaseValues& current() const { return current_; }
  void switch_off() { current_ = {}; }

 private:
  double force_constant_;
  PhaseValues current_{};
};

}  // namespace stiction::sim
