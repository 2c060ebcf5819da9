#include "sim/plant/axis_plant.hpp"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "sim/plant/acting_effects.hpp"
#include "sim/plant/encoders.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/laws.hpp"
#include "sim/plant/motor.hpp"

namespace stiction::sim {
namespace {

using MotorVariant = std::variant<DcMotor, SynchronousMotor, ForceSource>;

MotorVariant make_motor(const machine::AxisModel& axis, double step) {
  const machine::MotorParameters& motor = axis.motor;
  switch (motor.model) {
    case machine::MotorModel::dc:
      return DcMotor(motor, step);
    case machine::MotorModel::synchronous:
      return SynchronousMotor(motor, step, axis.encoder.commutation_offset);
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

AxisPlant::State::State(double step, int steps, const machine::AxisModel& axis, double start, std::uint64_t seed)
    : half_step(0.5 * step),
      inverter(axis.inverter, step, steps),
      mount(axis.encoder.mount, step),
      encoder_increment(axis.encoder.increment),
      increments_per_metre(1.0 / axis.encoder.increment),
      encoder_noise(axis.encoder.noise),
      random(seed + axis.encoder.noise_draw),
      position(start),
      phases(axis.motor.model == machine::MotorModel::synchronous ? 3 : 1) {}

struct AxisPlant::Moved final : State {
  Moved(double step, int steps, const machine::AxisModel& axis, double start, std::uint64_t seed)
      : State(step, steps, axis, start, seed),
        driving_motor(make_motor(axis, step)),
        acting_effects(axis, step, start),
        acting_friction(make_friction(axis.friction, acting_effects.carriage(axis))),
        encoders(axis, step, steps * step, start),
        steps_per_tick(steps),
        evenly(steps == plant_steps_per_tick && !inverter.changes_within_tick()),
        viscous(viscous_of(axis.friction)) {
    if (steps != plant_steps_per_tick) acting_effects.step_finely();
    if (axis.elastic() && axis.motor_friction) acting_effects.set_motor_friction(motor_friction(axis, step));
    mass_per_step = acting_effects.carriage(axis).mass / step;
    lost_position = acting_effects.reading_error(start).value;
    tick = chosen();
  }

  // Velocity of the motor (m/s) a step later, from the one before and the force on it (N).
  static std::function<double(double, double)> motor_friction(const machine::AxisModel& axis, double step) {
    return [law = make_friction(*axis.motor_friction, {axis.motor_mass, step}),
            viscous = viscous_of(*axis.motor_friction), change = 0.0](double velocity, double force) mutable {
      const double ahead = velocity != 0.0 ? 0.5 * viscous * change : 0.0;
      const double next =
          std::visit([&](auto& friction) -> double { return friction.advance(velocity, force + ahead); }, law);
      change = next - velocity;
      return next;
    };
  }

  Encoders::Body load_body() const { return {acting_effects.follower(), acting_effects.closed() ? velocity : 0.0}; }
  Encoders::Body motor_body() const {
    return {position + acting_effects.motor_lead(), velocity + acting_effects.motor_lead_rate()};
  }

  // The tick of this motor with this friction, with or without effects: chosen once; a visit of both costs 29
  // instructions a tick.
  Tick chosen() const;
  template <class MotorModel, class Friction, bool effects>
  static void advance(State& state);
  template <bool effects, class MotorModel, class Friction>
  [[gnu::always_inline]] void advance_evenly(MotorModel& motor, Friction& friction);
  template <bool effects, bool fine, class MotorModel, class Friction>
  void advance_unevenly(MotorModel& motor, Friction& friction);
  template <bool effects, bool fine, class MotorModel, class Friction>
  [[gnu::always_inline]] void step(MotorModel& motor, Friction& friction, PhaseValues voltage);

  MotorVariant driving_motor;
  ActingEffects acting_effects;
  FrictionModel acting_friction;
  Encoders encoders;
  int steps_per_tick;
  bool evenly;     // one voltage for a whole tick, of the usual number of steps
  double viscous;  // N s/m
};

template <class MotorModel, class Friction, bool effects>
void AxisPlant::Moved::advance(State& state) {
  auto& plant = static_cast<Moved&>(state);
  auto& friction = held<Friction>(plant.acting_friction);
  plant.inverter.advance_tick<MotorModel::phases>();
  if (plant.enabled) [[likely]] {
    auto& motor = held<MotorModel>(plant.driving_motor);
    if (!plant.evenly) [[unlikely]] {
      if (plant.steps_per_tick == plant_steps_per_tick)
        plant.advance_unevenly<effects, false>(motor, friction);
      else
        plant.advance_unevenly<effects, true>(motor, friction);
    } else {
      plant.advance_evenly<effects>(motor, friction);
    }
    const PhaseValues flowing = motor.current();
    for (std::size_t k = 0; k < MotorModel::phases; ++k) plant.current[k] = flowing[k];
  } else {
    OpenWindings none;
    plant.advance_unevenly<effects, false>(none, friction);
  }
  if constexpr (effects) {
    plant.lost_position = plant.acting_effects.follower() - plant.position;
    plant.lost_velocity = plant.acting_effects.closed() ? 0.0 : -plant.velocity;
    if (plant.encoders.any()) {
      const auto shown = plant.encoders.sample(plant.load_body(), plant.motor_body(), plant.random);
      plant.lost_position = shown.position - plant.position;
      plant.lost_velocity = shown.velocity - plant.velocity;
    }
    const auto error = plant.acting_effects.reading_error(plant.encoder_position());
    plant.lost_velocity += error.slope * plant.encoder_velocity();
    plant.lost_position += error.value;
  }
}

// With one voltage for the whole tick. It is copied: that nothing read in a step can be a part of the plant is what
// lets the compiler keep the plant's state in registers. The steps are written out, which saves one instruction in
// twelve.
template <bool effects, class MotorModel, class Friction>
inline void AxisPlant::Moved::advance_evenly(MotorModel& motor, Friction& friction) {
  const PhaseValues voltage = inverter.voltage<MotorModel::phases>();
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((static_cast<void>(i), step<effects, false>(motor, friction, voltage)), ...);
  }
  (std::make_index_sequence<plant_steps_per_tick>());
}

// Not inline: registers that it alone needs would cost each tick of the other 10 instructions.
template <bool effects, bool fine, class MotorModel, class Friction>
[[gnu::noinline]] void AxisPlant::Moved::advance_unevenly(MotorModel& motor, Friction& friction) {
  const auto acting = inverter.acting();
  for (int i = 0; i < steps_per_tick; ++i)
    step<effects, fine>(motor, friction,
                        i >= acting.change      ? acting.after
                        : i + 1 < acting.change ? acting.before
                                                : acting.between);
}

// Semi-implicit Euler: the new velocity from the forces, the position from the mean of old and new. `fine`: whoever
// asks for more steps wants them accurate. Then what follows the velocity takes that of the middle of the step, as the
// step before foretells it, which makes the step one of second order.
template <bool effects, bool fine, class MotorModel, class Friction>
inline void AxisPlant::Moved::step(MotorModel& motor, Friction& friction, PhaseValues voltage) {
  double friction_of_effects = 0.0;
  if constexpr (effects) {
    const double linear = motor.advance(voltage, position + acting_effects.motor_lead(),
                                        velocity + acting_effects.motor_lead_rate() +
                                            (fine ? 0.5 * (change + acting_effects.motor_lead_rate_change()) : 0.0));
    motor_force = acting_effects.motor_force(linear);
    const auto extra = acting_effects.advance(position, velocity, motor_force);
    applied_force = extra.applied + (acting_effects.transmitted(motor_force) - motor_force);
    force = motor_force + external_force + applied_force;
    friction_of_effects = extra.friction;
  } else {
    motor_force = motor.advance(voltage, position, fine ? velocity + 0.5 * change : velocity);
    force = motor_force + external_force;
  }
  double on_friction = effects ? force + friction_of_effects : force;
  // The laws take viscous friction at the end of the step.
  if constexpr (fine)
    if (velocity != 0.0) on_friction += 0.5 * viscous * change;
  const double next = friction.advance(velocity, on_friction);
  change = next - velocity;
  position += half_step * (velocity + next);
  velocity = next;
  mount.advance(effects ? acting_effects.follow(position, velocity, change) : change);
  if constexpr (effects)
    if (encoders.late()) encoders.record(load_body(), motor_body());
}

double AxisPlant::with_noise(double reading) {
  return reading + std::normal_distribution<double>(0.0, state_->encoder_noise)(state_->random);
}

// Behind the templates that it names: clang 14 forgets to instantiate, for a lambda like this, what is defined later.
AxisPlant::State::Tick AxisPlant::Moved::chosen() const {
  return std::visit([any = acting_effects.any() || encoders.any()]<class M, class F>(
                        const M&, const F&) -> Tick { return any ? advance<M, F, true> : advance<M, F, false>; },
                    driving_motor, acting_friction);
}

AxisPlant::AxisPlant(const machine::Timing& timing, const machine::AxisModel& axis, double position, std::uint64_t seed)
    : state_(std::make_unique<Moved>(timing.fast_period / timing.plant_steps, timing.plant_steps, plant_axis(axis),
                                     position, seed)) {}
AxisPlant::AxisPlant(AxisPlant&&) noexcept = default;
AxisPlant& AxisPlant::operator=(AxisPlant&&) noexcept = default;
AxisPlant::~AxisPlant() = default;

AxisPlant::Moved& AxisPlant::moved() { return static_cast<Moved&>(*state_); }
const AxisPlant::Moved& AxisPlant::moved() const { return static_cast<const Moved&>(*state_); }

bool AxisPlant::coupled() const { return moved().acting_effects.coupled(); }
void AxisPlant::set_other_acceleration(double acceleration) {
  moved().acting_effects.set_other_acceleration(acceleration);
}

std::optional<double> AxisPlant::read_velocity_encoder() {
  return moved().encoders.read_velocity_encoder(state_->random);
}
std::optional<double> AxisPlant::read_second_encoder() { return moved().encoders.read_second_encoder(state_->random); }
void AxisPlant::set_brake(bool released) { moved().acting_effects.set_brake(released, state_->position); }
double AxisPlant::motor_position() const { return moved().motor_body().position; }

// The freewheeling diodes end the currents within a fraction of a millisecond: here at once.
void AxisPlant::switch_off() {
  state_->inverter.switch_off();
  std::visit([](auto& motor) { motor.switch_off(); }, moved().driving_motor);
  state_->current = {};
}

}  // namespace stiction::sim
