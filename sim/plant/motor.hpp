// Motors: windings with resistance, inductance and back EMF under the inverter's voltage (Mendricky 2006, 3.1-3.14).
// Each winding takes the exact step of its R-L equation for voltage and EMF held over the step.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "firmware/machine/model/machine.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim {

// Motors are templates over the number in which they compute: a double, or a batch whose lanes are motors.
template <class Real>
using PhaseValuesOf = std::array<Real, 3>;
using PhaseValues = PhaseValuesOf<double>;

// Exact step of L di/dt = u - R i.
template <class Real>
class Winding {
 public:
  // `resistance`: Ohm, `inductance`: H, `step`: s, all above 0.
  Winding(double resistance, double inductance, double step)
      : decay_(std::exp(-resistance * step / inductance)), gain_((1.0 - decay_) / resistance) {}

  // Current (A) one step later under the voltage `u` (V) across R and L.
  Real advance(Real current, Real u) const { return decay_ * current + gain_ * u; }
  Real decay() const { return decay_; }
  Real gain() const { return gain_; }  // A per V in a step

 private:
  Real decay_;
  Real gain_;
};

// DC equivalent of the synchronous motor: R, L, K_E of one winding, K_F of the whole motor (3.14). `count` motors in
// parallel: the current is their sum, R and L are divided.
template <class Real>
class DcMotorOf {
 public:
  static constexpr std::size_t phases = 1;

  DcMotorOf(const machine::MotorParameters& motor, double step)
      : winding_(motor.phase_resistance / motor.count, motor.phase_inductance / motor.count, step),
        gain_(0.5 * motor.force_constant * winding_.gain()),
        emf_gain_(gain_ * motor.emf_constant),
        amperes_(2.0 / motor.force_constant) {}

  // Moves the current on by one step at velocity v (m/s); returns the mean force (N) over the step. What the voltage
  // adds is a term of its own, the same in every step that it is held. `voltage`: of the phases, of which the first is
  // used. The position, the number without a name, has no effect.
  // Each Real without a name has no effect.
  Real advance(const PhaseValuesOf<Real>& voltage, Real, Real v) {
    const Real before = half_force_;
    half_force_ = winding_.decay() * before + gain_ * voltage[0] - emf_gain_ * v;
    return before + half_force_;
  }
  PhaseValuesOf<Real> current() const { return {amperes_ * half_force_}; }
  void switch_off() { half_force_ = 0.0; }

 private:
  Winding<Real> winding_;
  Real gain_;              // N per V in a step, of half the force
  Real emf_gain_;          // N per m/s in a step, of half the force
  Real amperes_;           // A per N of half the force
  Real half_force_ = 0.0;  // N, in place of the current: a step costs a product less
};

using DcMotor = DcMotorOf<double>;

// Three-phase synchronous linear motor (3.7-3.12) with a star point: its currents sum to zero, so that the mutual
// inductance only lowers the effective one, L - M, and the mean of the phase voltages has no effect.
template <class Real>
class SynchronousMotorOf {
 public:
  static constexpr std::size_t phases = 3;

  // `motor`: windings and constants; `step`: of the plant, s; `offset`: rad, electrical angle at position zero.
  SynchronousMotorOf(const machine::MotorParameters& motor, double step, double offset = 0.0)
      : winding_(motor.phase_resistance / motor.count, (motor.phase_inductance - motor.mutual_inductance) / motor.count,
                 step),
        emf_constant_(motor.emf_constant),
        half_force_constant_(0.5 * motor.phase_force_constant),
        angle_per_metre_(2.0 * std::numbers::pi / motor.pole_pair_pitch),
        half_step_(0.5 * step),
        offset_(offset) {}

  // Moves the currents on by one step from position x (m) at velocity v (m/s); returns the mean force (N). `voltage`:
  // of the three phases, V.
  Real advance(const PhaseValuesOf<Real>& voltage, Real x, Real v) {
    const Real angle = angle_per_metre_ * (x + half_step_ * v) + offset_;
    const auto [s, c] = sine_cosine(angle);
    constexpr double half_root_3 = 0.5 * std::numbers::sqrt3;
    const PhaseValuesOf<Real> sine{s, -0.5 * s + half_root_3 * c, -0.5 * s - half_root_3 * c};
    const Real star = (voltage[0] + voltage[1] + voltage[2]) / 3.0;
    Real force = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Real before = current_[k];
      current_[k] = winding_.advance(before, voltage[k] - star - emf_constant_ * v * sine[k]);
      force += (before + current_[k]) * sine[k];
    }
    return half_force_constant_ * force;
  }
  const PhaseValuesOf<Real>& current() const { return current_; }
  void switch_off() { current_ = {}; }

 private:
  Winding<Real> winding_;
  Real emf_constant_;
  Real half_force_constant_;
  Real angle_per_metre_;
  Real half_step_;
  Real offset_;
  PhaseValuesOf<Real> current_{};
};
using SynchronousMotor = SynchronousMotorOf<double>;

// A motor whose power stage is off.
struct OpenWindings {
  // Neither the PhaseValues nor position and velocity, both double, have an effect.
  double advance(const PhaseValues&, double, double) { return 0.0; }
};

// Ideal force source driven by a voltage command, N/V.
template <class Real>
class ForceSourceOf {
 public:
  static constexpr std::size_t phases = 1;

  ForceSourceOf(const machine::MotorParameters& motor, double) : force_constant_(motor.force_constant) {}

  // Returns the force, N, of a `voltage`; position and velocity, without names, have no effect.
  // Each Real without a name has no effect.
  Real advance(const PhaseValuesOf<Real>& voltage, Real, Real) {
    current_[0] = voltage[0];
    return force_constant_ * voltage[0];
  }
  const PhaseValuesOf<Real>& current() const { return current_; }
  void switch_off() { current_ = {}; }

 private:
  Real force_constant_;
  PhaseValuesOf<Real> current_{};
};
using ForceSource = ForceSourceOf<double>;

}  // namespace stiction::sim
