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
      inverter_(axis.inverter, step_),
      motor_(make_motor(axis.motor, step_)),
      friction_(make_friction(axis.friction.models.at(axis.friction.use), {axis.mass, step_})),
      mount_(axis.encoder.mount, step_),
      encoder_increment_(axis.encoder.increment),
      encoder_noise_(axis.encoder.noise),
      random_(seed),
      position_(position) {}

void AxisPlant::command(const PhaseValues& voltage, bool enable) {
  enabled_ = enable;
  if (enable) {
    inverter_.command(voltage);
  } else {
    inverter_.switch_off();
    std::visit([](auto& motor) { motor.switch_off(); }, motor_);
  }
}

void AxisPlant::advance_tick() {
  std::visit(
      [this](auto& motor, auto& friction) {
        for (int i = 0; i < plant_steps_per_tick; ++i) {
          const PhaseValues& voltage = inverter_.advance();
          motor_force_ = enabled_ ? motor.advance(voltage, position_, velocity_) : 0.0;
          const double force = motor_force_ + external_force_;
          const double next = friction.advance(velocity_, force);
          const double acceleration = (next - velocity_) / step_;
          friction_force_ = force - mass_ * acceleration;
          position_ += 0.5 * step_ * (velocity_ + next);
          velocity_ = next;
          mount_.advance(acceleration);
        }
      },
      motor_, friction_);
}

const PhaseValues& AxisPlant::current() const {
  return std::visit([](const auto& motor) -> const PhaseValues& { return motor.current(); }, motor_);
}

double AxisPlant::read_encoder() {
  double reading = encoder_position();
  if (encoder_noise_ > 0.0) reading += std::normal_distribution<double>(0.0, encoder_noise_)(random_);
  if (encoder_increment_ > 0.0) reading = std::round(reading / encoder_increment_) * encoder_increment_;
  return reading;
}

}  // namespace stiction::sim
