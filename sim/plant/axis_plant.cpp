#include "sim/plant/axis_plant.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace stiction::sim {
namespace {

std::variant<DcMotor, SynchronousMotor, ForceSource> make_motor(const machine::MotorParameters& motor, double step) {
  switch (motor.model) {
    case machine::MotorModel::dc:
      return DcMotor(motor, step);
    case machine::MotorModel::synchronous:
      return SynchronousMotor(motor, step);
    case machine::MotorModel::force:
      return ForceSource(motor, step);
  }
  throw std::invalid_argument("motor.model: unknown model");
}

// The alternative that a variant is known to hold: tick() is chosen by it, and std::get would test it in every tick.
template <class T, class Variant>
T& held(Variant& variant) {
  T* const alternative = std::get_if<T>(&variant);
  if (alternative == nullptr) __builtin_unreachable();
  return *alternative;
}

}  // namespace

AxisPlant::AxisPlant(const machine::Timing& timing, const machine::AxisModel& axis, double position, std::uint64_t seed)
    : AxisPlant(timing.fast_period / plant_steps_per_tick, plant_axis(axis), position, seed) {}

AxisPlant::AxisPlant(double step, const machine::AxisModel& axis, double position, std::uint64_t seed)
    : half_step_(0.5 * step),
      inverter_(axis.inverter, step, plant_steps_per_tick),
      motor_(make_motor(axis.motor, step)),
      effects_(axis, step, position),
      mass_per_step_(effects_.carriage(axis).mass / step),
      friction_(make_friction(axis.friction, effects_.carriage(axis))),
      tick_(tick_of(motor_, friction_, effects_.any())),
      mount_(axis.encoder.mount, step),
      encoder_increment_(axis.encoder.increment),
      increments_per_metre_(1.0 / axis.encoder.increment),
      encoder_noise_(axis.encoder.noise),
      random_(seed),
      position_(position),
      lost_position_(effects_.reading_error(position).value),
      phases_(axis.motor.model == machine::MotorModel::synchronous ? 3 : 1) {}

// The freewheeling diodes end the currents within a fraction of a millisecond: here at once.
void AxisPlant::switch_off() {
  inverter_.switch_off();
  std::visit([](auto& motor) { motor.switch_off(); }, motor_);
  current_ = {};
}

template <class MotorModel, class Friction, bool effects>
void AxisPlant::tick(AxisPlant& plant) {
  auto& friction = held<Friction>(plant.friction_);
  plant.inverter_.advance_tick<MotorModel::phases>();
  if (plant.enabled_) [[likely]] {
    auto& motor = held<MotorModel>(plant.motor_);
    if (plant.inverter_.changes_within_tick()) [[unlikely]]
      plant.advance_unevenly<effects>(motor, friction);
    else
      plant.advance_evenly<effects>(motor, friction);
    const PhaseValues current = motor.current();
    for (std::size_t k = 0; k < MotorModel::phases; ++k) plant.current_[k] = current[k];
  } else {
    OpenWindings none;
    plant.advance_unevenly<effects>(none, friction);
  }
  if constexpr (effects) {
    plant.lost_position_ = plant.effects_.follower() - plant.position_;
    plant.lost_velocity_ = plant.effects_.closed() ? 0.0 : -plant.velocity_;
    const auto error = plant.effects_.reading_error(plant.encoder_position());
    plant.lost_velocity_ += error.slope * plant.encoder_velocity();
    plant.lost_position_ += error.value;
  }
}

// With one voltage for the whole tick. It is copied: that nothing read in a step can be a part of the plant is what
// lets the compiler keep the plant's state in registers. The steps are written out, which saves one instruction in
// twelve.
template <bool effects, class MotorModel, class Friction>
inline void AxisPlant::advance_evenly(MotorModel& motor, Friction& friction) {
  const PhaseValues voltage = inverter_.voltage<MotorModel::phases>();
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((static_cast<void>(i), step<effects>(motor, friction, voltage)), ...);
  }
  (std::make_index_sequence<plant_steps_per_tick>());
}

// Not inline: registers that it alone needs would cost each tick of the other 10 instructions.
template <bool effects, class MotorModel, class Friction>
[[gnu::noinline]] void AxisPlant::advance_unevenly(MotorModel& motor, Friction& friction) {
  const auto acting = inverter_.acting();
  for (int i = 0; i < plant_steps_per_tick; ++i)
    step<effects>(motor, friction,
                  i >= acting.change      ? acting.after
                  : i + 1 < acting.change ? acting.before
                                          : acting.between);
}

// Semi-implicit Euler: the new velocity from the forces, the position from the mean of old and new.
template <bool effects, class MotorModel, class Friction>
inline void AxisPlant::step(MotorModel& motor, Friction& friction, PhaseValues voltage) {
  double friction_of_effects = 0.0;
  if constexpr (effects) {
    const double linear =
        motor.advance(voltage, position_ + effects_.motor_lead(), velocity_ + effects_.motor_lead_rate());
    motor_force_ = effects_.motor_force(linear);
    const auto extra = effects_.advance(position_, velocity_, motor_force_);
    applied_force_ = extra.applied + (effects_.transmitted(motor_force_) - motor_force_);
    force_ = motor_force_ + external_force_ + applied_force_;
    friction_of_effects = extra.friction;
  } else {
    motor_force_ = motor.advance(voltage, position_, velocity_);
    force_ = motor_force_ + external_force_;
  }
  const double next = friction.advance(velocity_, effects ? force_ + friction_of_effects : force_);
  change_ = next - velocity_;
  position_ += half_step_ * (velocity_ + next);
  velocity_ = next;
  mount_.advance(effects ? effects_.follow(position_, velocity_, change_) : change_);
}

double AxisPlant::with_noise(double reading) {
  return reading + std::normal_distribution<double>(0.0, encoder_noise_)(random_);
}

// Behind the templates that it names: clang 14 forgets to instantiate, for a lambda like this, what is defined later.
AxisPlant::Tick AxisPlant::tick_of(const MotorVariant& motor_model, const FrictionModel& friction_model, bool effects) {
  return std::visit([effects]<class M, class F>(
                        const M&, const F&) -> Tick { return effects ? tick<M, F, true> : tick<M, F, false>; },
                    motor_model, friction_model);
}

}  // namespace stiction::sim
