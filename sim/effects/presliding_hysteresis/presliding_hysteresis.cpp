#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "sim/effects/effect_values.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::sim {
namespace {

// Displacement to the share y of Coulomb friction, in units of F_C/stiffness: the integral of u^-n from 1 - y to 1.
double displacement_at(double y, double n) {
  const double rest = -std::log1p(-y);
  const double a = (n - 1.0) * rest;
  return std::abs(a) < 1e-12 ? rest : rest * std::expm1(a) / a;
}

// The exponent with displacement_at(0.9, n) = sharpness; the displacement rises with n.
double exponent_of(double sharpness) {
  double low = 0.0, high = 20.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (displacement_at(0.9, middle) < sharpness ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

MaxwellSlipParameters presliding_elements(double coulomb, double stiffness, double distance) {
  const double sharpness = stiffness * distance / coulomb;
  if (!(coulomb > 0.0) || !PreslidingHysteresis::sharpness.contains(sharpness * (1.0 + 1e-12)))
    throw EffectError(PreslidingHysteresis::name,
                      fmt::format("stiffness times distance of {:g} N with a Coulomb friction of {:g} N",
                                  stiffness * distance, coulomb),
                      fmt::format("a product of {} to {} times Coulomb friction", PreslidingHysteresis::sharpness.low,
                                  PreslidingHysteresis::sharpness.high));
  const double n = exponent_of(sharpness);
  constexpr std::array<double, 11> shares{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.98};
  MaxwellSlipParameters elements;
  for (std::size_t j = 0; j < shares.size(); ++j) {
    const bool last = j + 1 == shares.size();
    const double slope = std::pow(1.0 - shares[j], n);
    const double next_slope = last ? 0.0 : std::pow(1.0 - shares[j + 1], n);
    const double fall = slope - next_slope;
    if (fall < 1e-9) continue;  // a straight piece needs no element
    // Where the tangent meets the next one, or Coulomb friction.
    const double next_share = last ? 1.0 : shares[j + 1];
    const double next_foot = last ? 0.0 : next_slope * displacement_at(shares[j + 1], n);
    const double slip = (next_share - shares[j] + slope * displacement_at(shares[j], n) - next_foot) / fall;
    elements.stiffness.push_back(stiffness * fall);
    elements.level.push_back(coulomb * fall * slip);
  }
  return elements;
}

namespace {

// Stiffness times distance over Coulomb friction; of a law without a contact an exponential curve's.
double sharpness_of(const machine::FrictionParameters& friction) {
  const auto contact = contact_of(friction);
  return contact ? contact->stiffness * contact->distance / contact->level : std::numbers::ln10;
}

MaxwellSlipParameters elements_of_share(const PreslidingHysteresis::Parameters& p, double level,
                                        const machine::FrictionParameters& friction) {
  return presliding_elements(level, p.stiffness.value_or(sharpness_of(friction) * level / p.distance), p.distance);
}

void replace_law(machine::FrictionParameters& friction, MaxwellSlipParameters elements) {
  elements.viscous = viscous_of(friction);
  with_law_in_use(friction, [&]<class Law>(const typename Law::Parameters& law) {
    if constexpr (requires { law.rise_velocity; }) {
      elements.rise = law.rise;
      elements.rise_velocity = law.rise_velocity;
    }
    return true;
  });
  friction.use = MaxwellSlip<>::name;
  friction.models[friction.use] = values_of<MaxwellSlip<>>(elements);
}

}  // namespace

void PreslidingHysteresis::change(const Parameters& p, machine::AxisModel& plant) {
  machine::FrictionParameters& friction = plant.friction;
  const double coulomb = coulomb_of(friction);
  if (p.share < 1.0) {
    elements_of_share(p, p.share * coulomb, friction);  // whether they fit
    const auto before = contact_of(friction);
    set_coulomb(friction, (1.0 - p.share) * coulomb);
    // Some laws keep their stiffness at another level.
    if (before) stretch_contact(friction, before->distance / contact_of(friction)->distance);
    return;
  }
  const auto contact = contact_of(friction);
  if (contact && !p.stiffness)
    stretch_contact(friction, p.distance / contact->distance);
  else
    replace_law(friction, presliding_elements(coulomb, p.stiffness.value_or(std::numbers::ln10 * coulomb / p.distance),
                                              p.distance));
}

PreslidingHysteresis::PreslidingHysteresis(const Parameters& p, Body body, const machine::AxisModel& axis) {
  if (p.share == 1.0) return;
  const double level = coulomb_of(axis.friction) * p.share / (1.0 - p.share);
  contact_.emplace(elements_of_share(p, level, axis.friction), body);
}

}  // namespace stiction::sim
