// The other axis' acceleration as a force on the carriage, positive in +x: F = mass a_other. A product of inertia, a
// guideway that is not square, a base that gives way.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

struct CrossAxisCoupling {
  struct Parameters {
    double mass = 0.0;
  };
  static constexpr std::string_view name = "cross_axis_coupling";
  static constexpr std::string_view text = "the other axis' acceleration leaks in as force";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"mass", "kg", machine::any_value(), &Parameters::mass, {}, "force in +x over the other axis' acceleration"},
  }};
};

}  // namespace stiction::sim
