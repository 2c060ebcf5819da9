// One simulated axis: inverter, motor, carriage with friction, encoder on its mount, and the effects of the machine
// file. Double precision, SI units.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <variant>

#include "firmware/machine/model/machine.hpp"
#include "sim/plant/acting_effects.hpp"
#include "sim/plant/encoder_mount.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/inverter.hpp"
#include "sim/plant/motor.hpp"

namespace stiction::sim {

// Steps of the plant in one fast tick of the drive. At four (15.6 us) the circle's errors are within 0.01 um of
// converged up to a contact stiffness of 1e8 N/m.
inline constexpr int plant_steps_per_tick = 4;

class AxisPlant {
 public:
  // At rest at `position` (m). `seed`: of the encoder's noise. Throws std::invalid_argument for an unknown model,
  // EffectError for effects that the axis cannot have. `timing`: periods of the loops; `axis`: motor, mechanics,
  // friction, encoder and effects.
  AxisPlant(const machine::Timing& timing, const machine::AxisModel& axis, double position, std::uint64_t seed);

  // What the drive commands from now on: voltages (V), or the power stage off.
  void command(const PhaseValues& voltage, bool enable) {
    enabled_ = enable;
    if (enable)
      inverter_.command(voltage);
    else
      switch_off();
  }
  // Force from outside on the carriage (N, positive in +x), held until changed.
  void set_external_force(double force) { external_force_ = force; }

  bool coupled() const { return effects_.coupled(); }  // whether the other axis' acceleration acts on the carriage
  // Of the other axis, m/s^2, held until changed.
  void set_other_acceleration(double acceleration) { effects_.set_other_acceleration(acceleration); }

  // Moves on by one fast tick of the drive.
  void advance_tick() { tick_(*this); }

  double position() const { return position_; }        // m, carriage
  double velocity() const { return velocity_; }        // m/s, carriage
  double motor_force() const { return motor_force_; }  // N, at the end of the last step
  // N, mean over the last step, positive opposes +v
  double friction_force() const { return force_ - mass_per_step_ * change_; }
  // m, before increment and noise
  double encoder_position() const { return position_ + lost_position_ + mount_.deflection(); }
  double encoder_velocity() const { return velocity_ + lost_velocity_ + mount_.velocity(); }  // m/s
  std::size_t phases() const { return phases_; }           // that carry current: 3, or 1
  const PhaseValues& current() const { return current_; }  // A, of the phases

  // What the encoder reads now: with increment and noise. Draws a new noise value at each call.
  double read_encoder() {
    double reading = encoder_position();
    if (encoder_noise_ > 0.0) [[unlikely]]
      reading = with_noise(reading);
    return nearest_increment(reading);
  }

 private:
  using MotorVariant = std::variant<DcMotor, SynchronousMotor, ForceSource>;
  using Tick = void (*)(AxisPlant&);

  AxisPlant(double step, const machine::AxisModel& axis, double position, std::uint64_t seed);
  static Tick tick_of(const MotorVariant& motor, const FrictionModel& friction, bool effects);
  template <class MotorModel, class Friction, bool effects>
  static void tick(AxisPlant& plant);
  template <bool effects, class MotorModel, class Friction>
  [[gnu::always_inline]] void advance_evenly(MotorModel& motor, Friction& friction);
  template <bool effects, class MotorModel, class Friction>
  void advance_unevenly(MotorModel& motor, Friction& friction);
  template <bool effects, class MotorModel, class Friction>
  [[gnu::always_inline]] void step(MotorModel& motor, Friction& friction, PhaseValues voltage);
  void switch_off();
  double with_noise(double reading);

  double nearest_increment(double reading) const {
    const double increments = reading * increments_per_metre_;
    // Beyond 2^51 increments a plant has run away; the reading passes as it is, for the control's border to refuse.
    // So it does without an increment.
    if (!(std::abs(increments) < 0x1p51)) [[unlikely]]
      return reading;
    constexpr double no_fraction = 0x1.8p52;  // added, it leaves no room for a fraction
    return encoder_increment_ * (increments + no_fraction - no_fraction);
  }

  double half_step_;
  InverterModel inverter_;
  MotorVariant motor_;
  ActingEffects effects_;
  double mass_per_step_;  // of the carriage
  FrictionModel friction_;
  // Of this motor with this friction, with or without effects: chosen once; a visit of both costs 29 instructions a
  // tick.
  Tick tick_;
  EncoderMountModel mount_;
  double encoder_increment_;
  double increments_per_metre_;
  double encoder_noise_;
  std::mt19937_64 random_;
  bool enabled_ = false;

  double position_;
  double velocity_ = 0.0;
  double motor_force_ = 0.0;
  double force_ = 0.0;   // N, of all but friction, in the last step
  double change_ = 0.0;  // m/s, of the velocity, in the last step
  double external_force_ = 0.0;
  double applied_force_ = 0.0;  // of effects that are no friction, and what the motor's way to the carriage adds
  double lost_position_;        // m, of what the encoder reads against the carriage, by play and reading errors
  double lost_velocity_ = 0.0;  // m/s
  std::size_t phases_;
  PhaseValues current_{};
};

}  // namespace stiction::sim
