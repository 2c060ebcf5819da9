#include "tests/host/batch/random_members.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "sim/effects/effects.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/axis_plant.hpp"

namespace stiction::host {
namespace {

std::vector<machine::Machine> shipped() {
  std::vector<machine::Machine> machines;
  for (const char* name : {"mcfv5050ln", "mcfv5050ln", "mcfv5050ln", "belt-axis", "cam-stand", "screw-linear-scale",
                           "screw-motor-encoder", "servo-joint", "vertical-axis"})
    machines.push_back(
        sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/" + name + ".toml"));
  return machines;
}

class Draw {
 public:
  explicit Draw(std::mt19937_64& random) : random_(random) {}

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  void scale(double& value, double by) { value *= std::exp(between(-by, by)); }

 private:
  std::mt19937_64& random_;
};

machine::FrictionCompensationParameters compensation(Draw& draw, const machine::AxisModel& axis) {
  machine::FrictionCompensationParameters c;
  constexpr std::array kinds{CompensationKind::off, CompensationKind::pulse, CompensationKind::friction,
                             CompensationKind::learning};
  c.use = kinds[draw.below(kinds.size())];
  c.pulse = {draw.between(0.0, 2e-3), 0.0,  1e-3, axis.max_acceleration, 2.0 * axis.max_acceleration,
             draw.between(0.0, 4e-3), 10e-3};
  machine::FrictionFeedforwardParameters f;
  f.look_ahead = draw.between(0.0, 1.5e-3);
  f.distance = {2e-6, 10e-6, 60e-6};
  const double ampere = 0.05 * axis.inverter.current_limit;
  f.level = {draw.between(0.1, 1.0) * ampere, draw.between(0.1, 1.0) * ampere, draw.between(0.1, 1.0) * ampere};
  f.contact_damping = draw.between(0.0, 2e-3);
  f.speed = {1e-3, 10e-3, 100e-3};
  f.forward = {0.1 * ampere, -0.1 * ampere, 0.3 * ampere};
  f.backward = {0.2 * ampere, -0.1 * ampere, 0.4 * ampere};
  c.friction = f;
  c.learning = {0.6, 0.02, 0.2, 0.5 * ampere, 0.3e-6, 1e-3, 1e-3};
  return c;
}

// What a machine file could have: other gains, laws, notches, encoders, thresholds.
void vary(machine::AxisModel& axis, Draw& draw) {
  const auto& models = axis.friction.models;
  if (draw.chance(0.6))
    axis.friction.use = std::next(models.begin(), static_cast<long>(draw.below(models.size())))->first;
  draw.scale(axis.mass, 0.2);
  draw.scale(axis.position_controller.gain, 0.3);
  draw.scale(axis.velocity_controller.gain, 0.3);
  draw.scale(axis.inverter.voltage_limit, 0.3);
  if (draw.chance(0.3)) axis.velocity_controller.integral_time.reset();
  if (draw.chance(0.3)) axis.position_controller.increment = draw.chance(0.5) ? 0.0 : 1e-6;
  if (draw.chance(0.3)) axis.encoder.increment = draw.between(10e-9, 2e-6);
  if (draw.chance(0.2)) axis.notch = {draw.between(150.0, 900.0), 0.1, 0.7};
  if (draw.chance(0.3)) axis.inverter.dead_time = draw.between(0.0, 150e-6);
  if (draw.chance(0.3)) axis.encoder.mount = {1.0, draw.between(300.0, 2000.0), draw.between(0.01, 0.3)};
  if (!axis.velocity_encoder && draw.chance(0.5))
    axis.encoder.velocity =
        draw.chance(0.5) ? machine::VelocitySource::ideal : machine::VelocitySource::mean_difference;
  axis.feedforward = {draw.between(0.5, 1.0), draw.between(0.0, 1.0)};
  if (draw.chance(0.2)) axis.supervision.following_error = draw.between(5e-6, 200e-6);
  if (draw.chance(0.1)) axis.supervision.over_speed = draw.between(0.01, 0.1);
  if (draw.chance(0.1)) axis.supervision.over_current = draw.between(0.05, 0.5) * axis.inverter.current_limit;
  if (draw.chance(0.1)) axis.velocity_controller.gain *= 30.0;  // a loop that oscillates
}

// Up to two effects that the axis can have.
void hide(machine::AxisModel& axis, Draw& draw) {
  const auto all = sim::all_effects();
  for (std::size_t k = 0, tries = 1 + draw.below(2); k < tries; ++k) {
    const sim::EffectId id = all[draw.below(all.size())];
    if (id->hidden.values == nullptr) continue;
    sim::Draw values(draw.below(1000));
    auto with = axis;
    try {
      with.effects.push_back(sim::effect_with(id, id->hidden.values(axis, values)));
      const sim::AxisPlant possible({}, with, 0.0, 1);
      axis = with;
    } catch (const sim::EffectError&) {  // not on this one
    }
  }
}

}  // namespace

std::vector<RandomMember> random_members(std::size_t count, std::mt19937_64& random) {
  Draw draw(random);
  const auto machines = shipped();
  std::vector<RandomMember> members;
  while (members.size() < count) {
    RandomMember member{machines[draw.below(machines.size())], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1};
    auto& axes = member.machine.axes;
    axes = {axes[draw.below(axes.size())]};
    auto& axis = axes.front();
    // Motors are those of the file, or of the cross table in all three ways.
    if (member.machine.id == "mcfv5050ln") {
      constexpr std::array motors{machine::MotorModel::dc, machine::MotorModel::synchronous};
      axis.motor.model = motors[draw.below(motors.size())];
    }
    vary(axis, draw);
    if (draw.chance(0.7)) {
      axis.friction_compensation = compensation(draw, axis);
      member.machine.timing.set_point_delay = draw.chance(0.5) ? 1e-3 : 2e-3;
    }
    if (draw.chance(0.1)) member.machine.timing.plant_steps = 8;
    member.amplitude = std::min(0.2 * axis.travel, draw.between(50e-6, 10e-3));
    member.rate = std::min(draw.between(20.0, 200.0), 0.5 * axis.max_velocity / member.amplitude);
    member.slow = draw.between(-1e-3, 1e-3);
    member.start = draw.between(-0.01, 0.01);
    if (draw.chance(0.2)) member.injected = draw.between(0.01, 0.2) * axis.inverter.current_limit;
    if (draw.chance(0.05)) member.breaks_at = static_cast<int>(draw.between(100.0, 1000.0));
    members.push_back(std::move(member));
  }
  for (auto& member : members) {
    auto& axis = member.machine.axes.front();
    if (draw.chance(0.3)) member.pushed = draw.between(-0.1, 0.1) * axis.max_acceleration * axis.mass;
    if (draw.chance(0.4)) hide(axis, draw);
  }
  return members;
}

sim::AxisSetPoint set_point_of(const RandomMember& m, int tick) {
  if (m.breaks_at >= 0 && tick >= m.breaks_at)
    return {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, std::numeric_limits<double>::infinity()};
  const double t = tick * m.machine.timing.fast_period, w = m.rate;
  // Begins and goes on without a step of position or speed.
  const double c = std::cos(w * t), s = std::sin(w * t), begun = 1.0 - std::exp(-100.0 * t);
  return {
      m.start + m.amplitude * begun * (1.0 - c) + m.slow * t * begun,
      m.amplitude * (begun * w * s + 100.0 * (1.0 - begun) * (1.0 - c)) + m.slow * (begun + 100.0 * t * (1.0 - begun)),
      m.amplitude * w * w * c * begun, tick / 300 % 2 == 0 ? m.injected : -m.injected};
}

double external_force_of(const RandomMember& m, int tick) { return m.pushed * std::sin(0.02 * tick); }

}  // namespace stiction::host
