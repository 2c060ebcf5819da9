// A cushion before the end of the travel: from `begin` on its force increases with the square of the displacement into
// it,
//   F = -stiffness (x - begin)^2 for x > begin.
// Not an effect of the product: it shows that a folder is all that one takes.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class EndCushion {
 public:
  struct Parameters {
    double begin = 0.0;
    double stiffness = 0.0;
  };
  static constexpr std::string_view name = "end_cushion";
  static constexpr std::string_view text = "a cushion before the end of the travel";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"begin", "m", machine::any_value(), &Parameters::begin, {}, "position from which it acts"},
      {"stiffness",
       "N/m^2",
       machine::positive(),
       &Parameters::stiffness,
       {},
       "force over the square of the displacement into it"},
  }};
  static constexpr bool is_friction = false;

  EndCushion(const Parameters& p, Body) : p_(p) {}

  double force(const CarriageState& s) const {
    const double way = s.position - p_.begin;
    return way > 0.0 ? -p_.stiffness * way * way : 0.0;
  }

 private:
  Parameters p_;
};

}  // namespace stiction::sim
