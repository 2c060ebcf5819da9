// Multi-element Maxwell-slip friction (Iwan 1966; Lampaert, Swevers, Al-Bender 2003): springs with sliders in
// parallel, f_i' = k_i v while |f_i| < level_i, plus viscous friction. Presliding with nonlocal memory; the sum of the
// levels is the Coulomb friction.
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"

namespace stiction::sim {

class MaxwellSlip {
 public:
  struct Parameters {
    std::vector<double> stiffness;
    std::vector<double> level;
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "maxwell_slip";
  static constexpr std::string_view label = "Maxwell-slip elements";
  static constexpr std::array<Parameter<Parameters>, 3> parameters{{
      {"stiffness", "N/m", positive(), &Parameters::stiffness, {}, "stiffness of each element"},
      {"level", "N", positive(), &Parameters::level, {}, "force at which each element slips; sum = Coulomb friction"},
      {"viscous", "N s/m", not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
  }};

  // Throws std::invalid_argument when the two lists differ in length.
  MaxwellSlip(const Parameters& p, Body body)
      : p_(p), step_(body.step), gain_(body.step / body.mass), force_(p.stiffness.size(), 0.0) {
    if (p.stiffness.size() != p.level.size())
      throw std::invalid_argument("maxwell_slip: 'stiffness' and 'level' differ in length");
  }

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    double contact = 0.0;
    for (std::size_t i = 0; i < force_.size(); ++i) {
      force_[i] = std::clamp(force_[i] + p_.stiffness[i] * velocity * step_, -p_.level[i], p_.level[i]);
      contact += force_[i];
    }
    return (velocity + gain_ * (force - contact)) / (1.0 + gain_ * p_.viscous);
  }

 private:
  Parameters p_;
  double step_;
  double gain_;
  std::vector<double> force_;
};

}  // namespace stiction::sim
