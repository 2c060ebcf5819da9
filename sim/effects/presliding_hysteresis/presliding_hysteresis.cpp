#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

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

void PreslidingHysteresis::change(const Parameters& p, machine::AxisModel& plant) {
  machine::FrictionParameters& friction = plant.friction;
  MaxwellSlipParameters elements = presliding_elements(coulomb_of(friction), p.stiffness, p.distance);
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

}  // namespace stiction::sim
