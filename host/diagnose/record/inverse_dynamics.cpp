#include "host/diagnose/record/inverse_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "host/diagnose/record/elastic_mode.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"
#include "sim/plant/acting_effects.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::host {
namespace {

// Below this share of the motion's highest speed sgn(v) is drawn out to a slope: what the encoder's noise makes of a
// standstill must not chatter between +-1.
constexpr double blurred = 5e-4;

double highest_speed(const Motion& motion) {
  double highest = 1e-9;
  for (const double v : motion.v) highest = std::max(highest, std::abs(v));
  return highest;
}

double soft_sign(double v, double width) { return std::clamp(v / width, -1.0, 1.0); }

// Friction that follows the speed alone: of steady sliding at each speed.
std::vector<double> by_speed(const Motion& motion, const sim::SteadyFriction& steady) {
  std::vector<double> force(motion.v.size());
  const double width = blurred * highest_speed(motion);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = steady(motion.v[i], soft_sign(motion.v[i], width));
  return force;
}

// A law with a contact, moved by the displacement from sample to sample; viscous friction with the speed.
template <class Law>
std::vector<double> by_contact(const typename Law::Parameters& parameters, double mass, const Motion& motion) {
  Law law(parameters, {mass, motion.period});
  const double viscous = Law::viscous(parameters);
  std::vector<double> force(motion.x.size());
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double moved = i == 0 ? 0.0 : motion.moved.empty() ? motion.x[i] - motion.x[i - 1] : motion.moved[i];
    force[i] = law.move_contact(moved / motion.period) + viscous * motion.v[i];
  }
  return force;
}

void add_mode(const sim::StructuralResonance::Parameters& mode, const machine::AxisModel& axis, const Motion& motion,
              std::vector<double>& force) {
  auto load = force;
  for (std::size_t i = 0; i < load.size(); ++i) load[i] -= axis.mass * motion.a[i];
  const auto columns =
      mode_columns({mode.frequency, mode.damping_ratio, mode.mass_ratio, mode.motor_measured != 0}, axis, motion, load);
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] += columns[0][i] + (columns.size() > 1 ? columns[1][i] / mode.mass_ratio : 0.0);
}

}  // namespace

std::vector<double> friction_along(const machine::AxisModel& axis, const Motion& motion) {
  return sim::with_law_in_use(axis.friction, [&]<class Law>(const typename Law::Parameters& p) {
    if constexpr (sim::ContactLaw<Law>)
      return by_contact<Law>(p, axis.mass, motion);
    else
      return by_speed(motion, sim::steady_friction(axis.friction));
  });
}

std::vector<double> force_along(const machine::AxisModel& axis, const Motion& motion) {
  auto force = friction_along(axis, motion);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += axis.mass * motion.a[i];
  // What the machine file says of forces on the carriage is known already: the motor need not hold it.
  sim::ActingEffects effects(axis, motion.period, motion.x.front(), motion.t.front());
  if (!effects.any()) return force;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!motion.other_a.empty()) effects.set_other_acceleration(motion.other_a[i]);
    const auto without = effects.advance(motion.x[i], motion.v[i], 0.0), with_one = effects.forces(1.0);
    const double per_motor_force = with_one.applied - without.applied;  // of those that follow the motor
    force[i] = (force[i] - without.applied - without.friction) / (1.0 + per_motor_force);
  }
  for (const auto& mode : sim::effects_of<sim::StructuralResonance>(axis)) add_mode(mode, axis, motion, force);
  for (double& f : force) f = effects.linear_force(f);
  return force;
}

std::vector<double> force_change(const machine::AxisModel& axis, const machine::AxisModel& changed,
                                 const Motion& motion, double by) {
  auto difference = force_along(changed, motion);
  const auto base = force_along(axis, motion);
  for (std::size_t i = 0; i < base.size(); ++i) difference[i] = (difference[i] - base[i]) / by;
  return difference;
}

std::vector<double> contact_level(const machine::AxisModel& axis, const Motion& motion) {
  return sim::with_law_in_use(axis.friction, [&]<class Law>(const typename Law::Parameters& p) {
    if constexpr (sim::ContactLaw<Law>) {
      auto level = by_contact<Law>(Law::rate_independent(p), axis.mass, motion);
      for (double& s : level) s /= Law::coulomb(p);
      return level;
    } else {
      return by_speed(motion, [](double, double sign) { return sign; });
    }
  });
}

double coulomb_of(const machine::AxisModel& axis) { return sim::coulomb_of(axis.friction); }

double viscous_of(const machine::AxisModel& axis) { return sim::viscous_of(axis.friction); }

std::optional<sim::Contact> contact_of(const machine::AxisModel& axis) { return sim::contact_of(axis.friction); }

machine::AxisModel with_coulomb(machine::AxisModel axis, double coulomb) {
  sim::set_coulomb(axis.friction, coulomb);
  return axis;
}

machine::AxisModel with_viscous(machine::AxisModel axis, double viscous) {
  sim::set_viscous(axis.friction, viscous);
  return axis;
}

machine::AxisModel with_contact_distance(machine::AxisModel axis, double distance) {
  if (const auto contact = contact_of(axis))
    sim::stretch_contact(axis.friction, distance / contact->distance);
  else
    sim::PreslidingHysteresis::change({.stiffness = {}, .distance = distance}, axis);
  return axis;
}

}  // namespace stiction::host
