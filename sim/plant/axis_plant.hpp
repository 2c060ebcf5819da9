// One simulated axis: inverter, motor, carriage with friction, encoder on its mount, and the effects of the machine
// file. Double precision, SI units.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>

#include "firmware/machine/model/machine.hpp"
#include "sim/plant/encoder_mount.hpp"
#include "sim/plant/inverter.hpp"
#include "sim/plant/plant_steps.hpp"

namespace stiction::sim {

class AxisPlant {
 public:
  // At rest at `position` (m). `seed`: of the encoder's noise. Throws std::invalid_argument for an unknown model,
  // EffectError for effects that the axis cannot have. `timing`: periods of the loops; `axis`: motor, mechanics,
  // friction, encoder and effects.
  AxisPlant(const machine::Timing& timing, const machine::AxisModel& axis, double position, std::uint64_t seed);
  AxisPlant(AxisPlant&&) noexcept;
  AxisPlant& operator=(AxisPlant&&) noexcept;
  ~AxisPlant();

  // What the drive commands from now on: voltages (V), or the power stage off.
  void command(const PhaseValues& voltage, bool enable) {
    state_->enabled = enable;
    if (enable)
      state_->inverter.command(voltage);
    else
      switch_off();
  }
  // Force from outside on the carriage (N, positive in +x), held until changed.
  void set_external_force(double force) { state_->external_force = force; }

  // The brake that holds the axis, where it has one, held until changed; released at the start. Whether it is
  // `released`.
  void set_brake(bool released);

  bool coupled() const;  // whether the other axis' acceleration acts on the carriage
  // Of the other axis, m/s^2, held until changed.
  void set_other_acceleration(double acceleration);

  // Moves on by one fast tick of the drive.
  void advance_tick() { state_->tick(*state_); }

  double position() const { return state_->position; }        // m, carriage
  double velocity() const { return state_->velocity; }        // m/s, carriage
  double motor_force() const { return state_->motor_force; }  // N, at the end of the last step
  // N, mean over the last step, positive opposes +v
  double friction_force() const { return state_->force - state_->mass_per_step * state_->change; }
  // m, before increment and noise
  double encoder_position() const { return state_->encoder_position(); }
  double encoder_velocity() const { return state_->encoder_velocity(); }  // m/s
  // m, for a controller that computes the speed by itself; none where the velocity loop has no encoder of its own.
  std::optional<double> read_velocity_encoder();
  std::optional<double> read_second_encoder();  // m; none where there is none
  double motor_position() const;                // m, of the motor: behind an elastic shaft its own
  const PhaseValues& commanded() const { return state_->inverter.commanded(); }  // V, by the drive
  std::size_t phases() const { return state_->phases; }                          // that carry current: 3, or 1
  const PhaseValues& current() const { return state_->current; }                 // A, of the phases

  // What the encoder reads now: with increment and noise. Draws a new noise value at each call.
  double read_encoder() {
    double reading = encoder_position();
    if (state_->encoder_noise > 0.0) [[unlikely]]
      reading = with_noise(reading);
    return nearest_increment(reading);
  }
  // The same reading as a whole number of increments from zero: of the last call. 0 without an increment.
  std::int64_t encoder_counts() const { return state_->encoder_counts; }

 private:
  // The plant's state. Whoever uses a plant sees this much of it; the motor, the effects and the friction that it moves
  // with are known to the source alone (Moved), so that no experiment is compiled again when one of them is edited.
  // They are one object: the compiler keeps its parts in registers only where it sees that they do not overlap.
  struct State {
    using Tick = void (*)(State&);

    State(double step, int steps, const machine::AxisModel& axis, double start, std::uint64_t seed);
    State(const State&) = delete;
    virtual ~State() = default;

    double encoder_position() const { return position + lost_position + mount.deflection(); }
    double encoder_velocity() const { return velocity + lost_velocity + mount.velocity(); }

    double half_step;
    InverterModel inverter;
    double mass_per_step = 0.0;  // of the carriage
    Tick tick = nullptr;
    EncoderMountModel mount;
    double encoder_increment;
    double increments_per_metre;
    double encoder_noise;
    std::int64_t encoder_counts = 0;  // of the last reading
    std::mt19937_64 random;
    bool enabled = false;

    double position;
    double velocity = 0.0;
    double motor_force = 0.0;
    double force = 0.0;   // N, of all but friction, in the last step
    double change = 0.0;  // m/s, of the velocity, in the last step
    double external_force = 0.0;
    double applied_force = 0.0;  // of effects that are no friction, and what the motor's way to the carriage adds
    double lost_position = 0.0;  // m, of what the encoder reads against the carriage, by play and reading errors
    double lost_velocity = 0.0;  // m/s
    std::size_t phases;
    PhaseValues current{};
  };
  struct Moved;

  Moved& moved();
  const Moved& moved() const;
  void switch_off();
  double with_noise(double reading);

  double nearest_increment(double reading) {
    const double increments = reading * state_->increments_per_metre;
    // Beyond 2^51 increments a plant has run away; the reading passes as it is, for the control's border to refuse.
    // So it does without an increment.
    if (!(std::abs(increments) < 0x1p51)) [[unlikely]]
      return reading;
    constexpr double no_fraction = 0x1.8p52;  // added, it leaves no room for a fraction
    const double whole = increments + no_fraction - no_fraction;
    state_->encoder_counts = static_cast<std::int64_t>(whole);
    return state_->encoder_increment * whole;
  }

  std::unique_ptr<State> state_;
};

}  // namespace stiction::sim
