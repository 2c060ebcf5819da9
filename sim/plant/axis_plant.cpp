#include "sim/plant/axis_plant.hpp"

#include <cmath>
#include <stdexcept>

namespace stiction::sim {
namespace {

std::variant<DcMotor, SynchronousMotor, ForceSource> make_motor(const Motor& motor, double step) {
  switch (motor.model) {
    case MotorModel::dc:
      return DcMotor(motor, step);
    case MotorModel::synchronous:
      return SynchronousMotor(motor, step);
    case MotorModel::force:
      return ForceSource(motor, step);
  }
  throw std::invalid_argument("motor.model: unknown model");
}

}  // namespace

AxisPlant::AxisPlant(const Timing& timing, const Axis& axis, double position, std::uint64_t seed)
    : step_(timing.fast_period / plant_steps_per_tick),
      mass_(axis.mass),
      inverter_(axis.inverter, step_, plant_steps_per_tick),
      motor_(make_motor(axis.motor, step_)),
      friction_(make_friction(axis.friction.models.at(axis.friction.use), {axis.mass, step_})),
      mount_(axis.encoder.mount, step_),
      encoder_increment_(axis.encoder.increment),
      increments_per_metre_(1.0 / axis.encoder.increment),
      encoder_noise_(axis.encoder.noise),
      random_(seed),
      position_(position),
      phases_(axis.motor.model == MotorModel::synchronous ? 3 : 1) {}

void AxisPlant::command(const PhaseValues& voltage, bool enable) {
  enabled_ = enable;
  if (enable)
    inverter_.command(voltage);
  else
    switch_off();
}

// The freewheeling diodes end the currents within a fraction of a millisecond: here at once.
void AxisPlant::switch_off() {
  inverter_.switch_off();
  std::visit([](auto& motor) { motor.switch_off(); }, motor_);
  current_ = {};
}

void AxisPlant::advance_tick() {
  const auto acting = inverter_.advance_tick();
  if (!enabled_) {
    OpenWindings none;
    std::visit([&](auto& friction) { advance(none, friction, acting.after, plant_steps_per_tick); }, friction_);
    return;
  }
  std::visit(
      [&](auto& motor, auto& friction) {
        if (acting.change > 0) advance(motor, friction, acting.before, acting.change);
        if (acting.change < plant_steps_per_tick)
          advance(motor, friction, acting.after, plant_steps_per_tick - acting.change);
        current_ = motor.current();
      },
      motor_, friction_);
}

// Semi-implicit Euler: the new velocity from the forces, the position from the mean of old and new. What changes is
// kept in local variables, because the compiler must otherwise store every member at every step.
template <class MotorModel, class Friction>
void AxisPlant::advance(MotorModel& motor_state, Friction& friction, const PhaseValues& acting, int steps) {
  const double half_step = 0.5 * step_, external_force = external_force_;
  const PhaseValues voltage = acting;
  MotorModel motor = motor_state;
  EncoderMountModel mount = mount_;
  double position = position_, velocity = velocity_, motor_force = 0.0, change = 0.0;
  for (int i = 0; i < steps; ++i) {
    motor_force = motor.advance(voltage, position, velocity);
    const double next = friction.advance(velocity, motor_force + external_force);
    change = next - velocity;
    position += half_step * (velocity + next);
    velocity = next;
    mount.advance(change);
  }
  motor_state = motor;
  mount_ = mount;
  position_ = position;
  velocity_ = velocity;
  motor_force_ = motor_force;
  friction_force_ = motor_force + external_force - mass_ * change / step_;
}

double AxisPlant::read_encoder() {
  double reading = encoder_position();
  if (encoder_noise_ > 0.0) reading += std::normal_distribution<double>(0.0, encoder_noise_)(random_);
  if (encoder_increment_ > 0.0) {
    const double increments = reading * increments_per_metre_;
    // Beyond 2^62 increments a plant has run away; the reading passes as it is, for the control's border to refuse.
    if (std::abs(increments) < 0x1p62)
      reading = encoder_increment_ *
                static_cast<double>(static_cast<std::int64_t>(increments + std::copysign(0.5, increments)));
  }
  return reading;
}

}  // namespace stiction::sim
