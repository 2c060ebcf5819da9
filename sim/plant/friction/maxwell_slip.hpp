// Multi-element Maxwell-slip friction (Iwan 1966; Lampaert, Swevers, Al-Bender 2003): springs with sliders in parallel,
//   f_i' = k_i v while |f_i| < L_i, else |f_i| = L_i,
// plus viscous friction. Presliding with nonlocal memory; the sum of the levels at rest, level_i, is the friction of
// creeping. Optionally the sliders are rate-and-state dependent (slip law of Ruina 1983): towards the sliding curve
//   L_i -> level_i (1 + rise / sum(level) (1 - exp(-|v| / rise_velocity)))
// a slider's level moves as it slips, over the displacement at which the last of them breaks away; a sticking one keeps
// its level. So the friction of steady sliding is sum(level) + rise (1 - exp(-|v| / rise_velocity)) + viscous |v|, and
// a short stop forgets none of it. No element does work: its slip is never against its force.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

struct MaxwellSlipParameters {
  std::vector<double> stiffness;
  std::vector<double> level;
  double viscous = 0.0;
  double rise = 0.0;
  double rise_velocity = 0.01;
};

template <class Real = double>
class MaxwellSlip {
 public:
  using Scalar = Real;
  using Parameters = MaxwellSlipParameters;
  static constexpr std::string_view name = "maxwell_slip";
  static constexpr std::string_view label = "Maxwell-slip elements";
  static constexpr std::array<machine::Parameter<Parameters>, 5> parameters{{
      {"stiffness", "N/m", machine::positive(), &Parameters::stiffness, {}, "stiffness of each element"},
      {.key = "level",
       .unit = "N",
       .range = machine::positive(),
       .member = &Parameters::level,
       .fallback = {},
       .text = "force at which each element slips; sum = Coulomb friction",
       .as_long_as = "stiffness"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
      {"rise", "N", machine::not_negative(), &Parameters::rise, 0.0,
       "rise of all levels together from creeping to sliding"},
      {"rise_velocity", "m/s", machine::positive(), &Parameters::rise_velocity, 0.01, "speed with 63 % of the rise"},
  }};
  static double coulomb(const Parameters& p) { return sum(p.level); }
  static double viscous(const Parameters& p) { return p.viscous; }
  // The elements keep their stiffness; their levels are scaled to the new sum.
  static void set_coulomb(Parameters& p, double coulomb) {
    const double scale = coulomb / sum(p.level);
    for (double& level : p.level) level *= scale;
  }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }
  static Parameters rate_independent(Parameters p) {
    p.rise = p.viscous = 0.0;
    return p;
  }
  static void stretch(Parameters& p, double factor) {
    for (double& stiffness : p.stiffness) stiffness /= factor;
  }

  // As many stiffnesses as levels.
  MaxwellSlip(const Parameters& p, Body body)
      : elements_(std::min(p.stiffness.size(), p.level.size())),
        step_(body.step),
        gain_(body.step / body.mass),
        viscous_(p.viscous),
        rise_(p.rise),
        relative_rise_(p.rise / sum(p.level)),
        rise_velocity_(p.rise_velocity),
        rises_(p.rise > 0.0) {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      elements_[i] = {p.stiffness[i], p.level[i], p.level[i], 0.0};
      memory_ = std::max<Real>(memory_, p.level[i] / p.stiffness[i]);
    }
  }

  Real advance(Real velocity, Real force) {
    const Real contact = move_contact(velocity);
    return (velocity + gain_ * (force - contact)) / (1.0 + gain_ * viscous_);
  }
  Real steady_force(Real velocity, Real direction) const {
    const Real rise = rises_ ? rise_ * risen(absolute(velocity) / rise_velocity_) : 0.0;
    return (level() + rise) * direction + viscous_ * velocity;
  }
  // The share of the rise from creeping to sliding that is there at `ratio` rise velocities, not negative.
  static Real risen(Real ratio) { return one_minus_exp(ratio); }
  // The curve of first loading rises; its point at 90 % is found by halves, from 0 to its last corner.
  std::optional<Contact> contact() const {
    Real stiffness = 0.0;
    for (const Element& e : elements_) stiffness += e.stiffness;
    Real low = 0.0, high = memory_;
    for (int i = 0; i < 60; ++i) {
      const Real middle = 0.5 * (low + high);
      (loaded(middle) < 0.9 * level() ? low : high) = middle;
    }
    return Contact{level(), stiffness, high};
  }

  // Moves the contact for one step of held velocity (m/s); returns the sum of the elements' forces (N) at its end.
  Real move_contact(Real velocity) {
    const Real travel = velocity * step_;
    const Real sliding = rises_ ? 1.0 + relative_rise_ * risen(absolute(velocity) / rise_velocity_) : 1.0;
    Real contact = 0.0;
    for (Element& e : elements_) {
      const Real stretched = e.force + e.stiffness * travel;
      const Real excess = absolute(stretched) - e.level;
      if (excess > 0.0 && rises_)
        e.level += (sliding * e.level_at_rest - e.level) * one_minus_exp(excess / (e.stiffness * memory_));
      e.force = std::clamp(stretched, -e.level, e.level);
      contact += e.force;
    }
    return contact;
  }

 private:
  struct Element {
    Real stiffness, level_at_rest;
    Real level;  // at which it slips now, N
    Real force;  // N
  };

  static double sum(const std::vector<double>& values) {
    double total = 0.0;
    for (const double value : values) total += value;
    return total;
  }
  Real level() const {
    Real total = 0.0;
    for (const Element& e : elements_) total += e.level_at_rest;
    return total;
  }
  // N, a displacement (m) after rest.
  Real loaded(Real displacement) const {
    Real force = 0.0;
    for (const Element& e : elements_) force += std::min(e.stiffness * displacement, e.level_at_rest);
    return force;
  }

  std::vector<Element> elements_;
  Real step_;
  Real gain_;
  Real viscous_;
  Real rise_;
  Real relative_rise_;  // rise / sum of the levels
  Real rise_velocity_;
  bool rises_;
  Real memory_ = 0.0;  // m, the longest break-away displacement: of slip over which the levels follow the speed
};

}  // namespace stiction::sim
