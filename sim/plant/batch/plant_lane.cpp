#include "sim/plant/batch/plant_lane.hpp"

#include <cstring>
#include <type_traits>
#include <variant>

#include "sim/effects/effects.hpp"
#include "sim/plant/acting_effects.hpp"
#include "sim/plant/encoder_mount.hpp"
#include "sim/plant/encoders.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/laws.hpp"
#include "sim/plant/inverter.hpp"
#include "sim/plant/motor.hpp"

namespace stiction::sim {
namespace {

// An object that is doubles and nothing else, as these.
template <class Object>
std::vector<double> numbers_of(const Object& object) {
  static_assert(std::is_trivially_copyable_v<Object> && sizeof(Object) % sizeof(double) == 0);
  std::vector<double> numbers(sizeof(Object) / sizeof(double));
  std::memcpy(numbers.data(), &object, sizeof(Object));
  return numbers;
}

std::vector<double> motor_numbers(const machine::AxisModel& axis, double step) {
  const machine::MotorParameters& motor = axis.motor;
  switch (motor.model) {
    case machine::MotorModel::dc:
      return numbers_of(DcMotor(motor, step));
    case machine::MotorModel::synchronous:
      return numbers_of(SynchronousMotor(motor, step, axis.encoder.commutation_offset));
    case machine::MotorModel::force:
      return numbers_of(ForceSource(motor, step));
  }
  throw std::invalid_argument("motor.model: unknown model");
}

// None of a law whose state is more than doubles, or that needs powers.
std::vector<double> friction_numbers(const FrictionModel& model) {
  return std::visit(
      []<class Law>(const Law& law) -> std::vector<double> {
        if constexpr (std::is_trivially_copyable_v<Law> && !std::is_same_v<Law, Dahl<>> &&
                      !std::is_same_v<Law, Parabolic<>>)
          return numbers_of(law);
        else
          return {};
      },
      model);
}

}  // namespace

std::optional<PlantLane> plant_lane(const machine::Timing& timing, const machine::AxisModel& given, double position) {
  const machine::AxisModel axis = plant_axis(given);
  const double step = timing.fast_period / timing.plant_steps;
  const ActingEffects effects(axis, step, position);
  const Encoders encoders(axis, step, timing.plant_steps * step, position);
  if (!effects.only_forces() || encoders.any() || axis.encoder.noise > 0.0) return std::nullopt;
  PlantLane lane;
  lane.friction = friction_numbers(make_friction(axis.friction, effects.carriage(axis)));
  if (lane.friction.empty()) return std::nullopt;
  const InverterModel inverter(axis.inverter, step, timing.plant_steps);
  lane.kind = {axis.motor.model, axis.friction.use, timing.plant_steps, inverter.change(), inverter.commands()};
  lane.half_step = 0.5 * step;
  lane.position = position;
  lane.encoder_increment = axis.encoder.increment;
  lane.increments_per_metre = 1.0 / axis.encoder.increment;
  lane.viscous = viscous_of(axis.friction);
  lane.voltage_limit = inverter.voltage_limit();
  lane.share_before = inverter.share_before();
  lane.motor = motor_numbers(axis, step);
  lane.mount = numbers_of(EncoderMountModel(axis.encoder.mount, step));
  return lane;
}

}  // namespace stiction::sim
