#include "host/diagnose/inverse_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/identify/filter.hpp"
#include "sim/plant/effects/acting_effects.hpp"

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

// Friction that follows the speed alone.
template <class Law>
std::vector<double> by_speed(const Motion& motion, Law&& law) {
  std::vector<double> force(motion.v.size());
  const double width = blurred * highest_speed(motion);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = law(motion.v[i], soft_sign(motion.v[i], width));
  return force;
}

// A model with a contact, moved by the displacement from sample to sample; viscous friction with the speed.
template <class Model>
std::vector<double> by_contact(const typename Model::Parameters& parameters, double mass, const Motion& motion) {
  Model model(parameters, {mass, motion.period});
  std::vector<double> force(motion.x.size());
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double moved = i == 0 ? 0.0 : motion.x[i] - motion.x[i - 1];
    force[i] = model.move_contact(moved / motion.period) + parameters.viscous * motion.v[i];
  }
  return force;
}

struct Along {
  const Motion& motion;
  double mass;

  std::vector<double> operator()(const sim::CoulombViscous::Parameters& p) const {
    return by_speed(motion, [&](double v, double sign) { return p.coulomb * sign + p.viscous * v; });
  }
  std::vector<double> operator()(const sim::Classical::Parameters& p) const {
    return by_speed(motion, [&](double v, double sign) { return p.coulomb * sign + p.viscous * v; });
  }
  std::vector<double> operator()(const sim::LinearRamp::Parameters& p) const {
    const double edge = p.coulomb / p.slope;
    return by_speed(motion, [&](double v, double) {
      return std::abs(v) <= edge ? p.slope * v : std::copysign(p.coulomb + p.viscous * (std::abs(v) - edge), v);
    });
  }
  std::vector<double> operator()(const sim::Parabolic::Parameters& p) const {
    return by_speed(motion, [&](double v, double) {
      return std::copysign(p.force_at_1_m_per_s * std::pow(std::abs(v), 1.0 / p.order), v);
    });
  }
  std::vector<double> operator()(const sim::LuGre::Parameters& p) const {
    return by_contact<sim::LuGre>(p, mass, motion);
  }
  std::vector<double> operator()(const sim::MaxwellSlip::Parameters& p) const {
    return by_contact<sim::MaxwellSlip>(p, mass, motion);
  }
};

template <class P>
constexpr bool has_coulomb = requires(P p) {
  p.coulomb;
};
template <class P>
constexpr bool has_viscous = requires(P p) {
  p.viscous;
};

const sim::FrictionParameters& in_use(const sim::Axis& axis) { return axis.friction.models.at(axis.friction.use); }
sim::FrictionParameters& in_use(sim::Axis& axis) { return axis.friction.models.at(axis.friction.use); }

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

void add_mode(const sim::StructuralResonance::Parameters& mode, const sim::Axis& axis, const Motion& motion,
              std::vector<double>& force) {
  const auto columns = mode_columns(axis.mass, mode.mass_ratio, motion, force);
  const double w = 2.0 * std::numbers::pi * mode.frequency;
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] += (columns.bend[i] + 2.0 * mode.damping_ratio / w * columns.damping[i]) / (w * w);
}

}  // namespace

ModeColumns mode_columns(double mass, double ratio, const Motion& motion, const std::vector<double>& force) {
  constexpr int points = 7;
  const auto rate = [&](const std::vector<double>& values) {
    return central_difference(values, motion.period, points);
  };
  // With its inertia the load's force is M a + load/r, for the load's share of the mass.
  auto bent = force;
  for (std::size_t i = 0; i < bent.size(); ++i) bent[i] = mass * motion.a[i] + (force[i] - mass * motion.a[i]) / ratio;
  ModeColumns columns{rate(rate(bent)), {}};
  columns.damping = rate(columns.bend);
  for (double& v : columns.damping) v = -v;
  return columns;
}

std::vector<double> friction_along(const sim::Axis& axis, const Motion& motion) {
  return std::visit(Along{motion, axis.mass}, in_use(axis));
}

std::vector<double> force_along(const sim::Axis& axis, const Motion& motion) {
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

std::vector<double> force_change(const sim::Axis& axis, const sim::Axis& changed, const Motion& motion, double by) {
  auto difference = force_along(changed, motion);
  const auto base = force_along(axis, motion);
  for (std::size_t i = 0; i < base.size(); ++i) difference[i] = (difference[i] - base[i]) / by;
  return difference;
}

std::vector<double> contact_level(const sim::Axis& axis, const Motion& motion) {
  const auto coulomb = coulomb_of(axis);
  const bool contact = contact_stiffness_of(axis).has_value();
  if (!contact || !coulomb || *coulomb <= 0.0) return by_speed(motion, [](double, double sign) { return sign; });
  auto bare = with_viscous(axis, 0.0);
  auto& model = in_use(bare);
  if (auto* lugre = std::get_if<sim::LuGre::Parameters>(&model)) {
    lugre->static_ratio = 1.0;
    lugre->damping_ratio = 0.0;
  } else if (auto* slip = std::get_if<sim::MaxwellSlip::Parameters>(&model)) {
    slip->rise = 0.0;
  }
  auto level = friction_along(bare, motion);
  for (double& s : level) s /= *coulomb;
  return level;
}

std::optional<double> coulomb_of(const sim::Axis& axis) {
  return std::visit(
      []<class P>(const P& p) -> std::optional<double> {
        if constexpr (has_coulomb<P>)
          return p.coulomb;
        else if constexpr (std::is_same_v<P, sim::MaxwellSlip::Parameters>)
          return sum_of(p.level);
        else
          return std::nullopt;
      },
      in_use(axis));
}

std::optional<double> viscous_of(const sim::Axis& axis) {
  return std::visit(
      []<class P>(const P& p) -> std::optional<double> {
        if constexpr (has_viscous<P>)
          return p.viscous;
        else
          return std::nullopt;
      },
      in_use(axis));
}

std::optional<double> contact_stiffness_of(const sim::Axis& axis) {
  const auto& model = in_use(axis);
  if (const auto* lugre = std::get_if<sim::LuGre::Parameters>(&model)) return lugre->stiffness;
  if (const auto* slip = std::get_if<sim::MaxwellSlip::Parameters>(&model)) return sum_of(slip->stiffness);
  return std::nullopt;
}

double contact_distance_of(const sim::Axis& axis) {
  const auto& model = in_use(axis);
  if (const auto* lugre = std::get_if<sim::LuGre::Parameters>(&model))
    return lugre->coulomb * std::numbers::ln10 / lugre->stiffness;
  const auto* slip = std::get_if<sim::MaxwellSlip::Parameters>(&model);
  if (slip == nullptr) return 0.0;
  // The curve of first loading rises: from its initial slope and its last corner, by halves.
  const auto force_at = [&](double x) {
    double force = 0.0;
    for (std::size_t k = 0; k < slip->level.size(); ++k) force += std::min(slip->stiffness[k] * x, slip->level[k]);
    return force;
  };
  double low = 0.0, high = 0.0;
  for (std::size_t k = 0; k < slip->level.size(); ++k) high = std::max(high, slip->level[k] / slip->stiffness[k]);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (force_at(middle) < 0.9 * sum_of(slip->level) ? low : high) = middle;
  }
  return high;
}

sim::Axis with_coulomb(sim::Axis axis, double coulomb) {
  std::visit(
      [coulomb]<class P>(P& p) {
        if constexpr (has_coulomb<P>) {
          p.coulomb = coulomb;
        } else if constexpr (std::is_same_v<P, sim::MaxwellSlip::Parameters>) {
          const double scale = coulomb / sum_of(p.level);
          for (double& level : p.level) level *= scale;
        }
      },
      in_use(axis));
  return axis;
}

sim::Axis with_viscous(sim::Axis axis, double viscous) {
  std::visit(
      [viscous]<class P>(P& p) {
        if constexpr (has_viscous<P>) p.viscous = viscous;
      },
      in_use(axis));
  return axis;
}

sim::Axis with_contact_distance(sim::Axis axis, double distance) {
  const double shorter = contact_distance_of(axis) / distance;
  auto& model = in_use(axis);
  if (auto* lugre = std::get_if<sim::LuGre::Parameters>(&model)) {
    lugre->stiffness *= shorter;
  } else if (auto* slip = std::get_if<sim::MaxwellSlip::Parameters>(&model)) {
    for (double& stiffness : slip->stiffness) stiffness *= shorter;
  } else {
    const double stiffness = *coulomb_of(axis) * std::numbers::ln10 / distance;
    sim::PreslidingHysteresis::change({stiffness, distance}, axis);
  }
  return axis;
}

}  // namespace stiction::host
