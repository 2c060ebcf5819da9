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
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

class MaxwellSlip {
 public:
  struct Parameters {
    std::vector<double> stiffness;
    std::vector<double> level;
    double viscous = 0.0;
    double rise = 0.0;
    double rise_velocity = 0.01;
  };
  static constexpr std::string_view name = "maxwell_slip";
  static constexpr std::string_view label = "Maxwell-slip elements";
  static constexpr std::array<Parameter<Parameters>, 5> parameters{{
      {"stiffness", "N/m", positive(), &Parameters::stiffness, {}, "stiffness of each element"},
      {"level", "N", positive(), &Parameters::level, {}, "force at which each element slips; sum = Coulomb friction"},
      {"viscous", "N s/m", not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
      {"rise", "N", not_negative(), &Parameters::rise, 0.0, "rise of all levels together from creeping to sliding"},
      {"rise_velocity", "m/s", positive(), &Parameters::rise_velocity, 0.01, "speed with 63 % of the rise"},
  }};

  // Throws std::invalid_argument when the two lists differ in length.
  MaxwellSlip(const Parameters& p, Body body)
      : p_(p),
        step_(body.step),
        gain_(body.step / body.mass),
        relative_rise_(p.rise / std::accumulate(p.level.begin(), p.level.end(), 0.0)),
        rises_(p.rise > 0.0),
        memory_(memory_of(p)),
        level_(p.level),
        force_(p.stiffness.size(), 0.0) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    const double contact = move_contact(velocity);
    return (velocity + gain_ * (force - contact)) / (1.0 + gain_ * p_.viscous);
  }

  // Moves the contact for one step of held velocity (m/s); returns the sum of the elements' forces (N) at its end.
  double move_contact(double velocity) {
    const double travel = velocity * step_;
    const double sliding = rises_ ? 1.0 + relative_rise_ * one_minus_exp(std::abs(velocity) / p_.rise_velocity) : 1.0;
    double contact = 0.0;
    for (std::size_t i = 0; i < force_.size(); ++i) {
      const double stretched = force_[i] + p_.stiffness[i] * travel;
      const double excess = std::abs(stretched) - level_[i];
      if (excess > 0.0 && rises_)
        level_[i] += (sliding * p_.level[i] - level_[i]) * one_minus_exp(excess / (p_.stiffness[i] * memory_));
      force_[i] = std::clamp(stretched, -level_[i], level_[i]);
      contact += force_[i];
    }
    return contact;
  }

 private:
  // m, the longest break-away displacement.
  static double memory_of(const Parameters& p) {
    if (p.stiffness.size() != p.level.size())
      throw std::invalid_argument("maxwell_slip: 'stiffness' and 'level' differ in length");
    double longest = 0.0;
    for (std::size_t i = 0; i < p.level.size(); ++i) longest = std::max(longest, p.level[i] / p.stiffness[i]);
    return longest;
  }

  Parameters p_;
  double step_;
  double gain_;
  double relative_rise_;  // rise / sum of the levels
  bool rises_;
  double memory_;              // m, of slip over which the levels follow the speed
  std::vector<double> level_;  // at which each element slips now, N
  std::vector<double> force_;  // of each element, N
};

}  // namespace stiction::sim
