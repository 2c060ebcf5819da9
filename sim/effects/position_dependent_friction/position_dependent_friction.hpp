// Friction whose level varies along the stroke: extra friction force(x) sgn v, force(x) linear between the positions
// given and constant outside them. A guide out of line, a dry stretch, a tight screw. sgn v is the direction of
// carriage_state.hpp.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::sim {

class PositionDependentFriction {
 public:
  struct Parameters {
    std::vector<double> position, force;
  };
  static constexpr std::string_view name = "position_dependent_friction";
  static constexpr std::string_view text = "a friction level that varies along the stroke";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"position", "m", machine::any_value(), &Parameters::position, {}, "rising positions, at least one"},
      {"force",
       "N",
       machine::any_value(),
       &Parameters::force,
       {},
       "change of the level at each; linear between, else constant"},
  }};
  static constexpr bool is_friction = true;

  // Throws EffectError.
  static void check(const Parameters& p) {
    if (p.position.empty()) throw EffectError(name, "no position", "at least one");
    if (p.force.size() != p.position.size())
      throw EffectError(name, fmt::format("a list of {} as force", p.force.size()),
                        fmt::format("a list of {}, as many as position has", p.position.size()));
    for (std::size_t k = 1; k < p.position.size(); ++k)
      if (!(p.position[k] > p.position[k - 1]))
        throw EffectError(name, fmt::format("{:g} m behind {:g} m", p.position[k], p.position[k - 1]),
                          "rising positions");
  }

  PositionDependentFriction(const Parameters& p, Body) : p_(p) {}

  double force(const CarriageState& s) const { return -level(s.position) * s.direction; }

  // N, of friction above the model's at `x` (m).
  double level(double x) const {
    if (x <= p_.position.front()) return p_.force.front();
    if (x >= p_.position.back()) return p_.force.back();
    const auto next = std::upper_bound(p_.position.begin(), p_.position.end(), x);
    const auto k = static_cast<std::size_t>(next - p_.position.begin());
    const double share = (x - p_.position[k - 1]) / (p_.position[k] - p_.position[k - 1]);
    return p_.force[k - 1] + share * (p_.force[k] - p_.force[k - 1]);
  }

 private:
  Parameters p_;
};

}  // namespace stiction::sim
