// The radius of a rotary axis: the largest power of two at which the drive's number formats hold its configuration. The
// larger it is, the finer is a bit of its position.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// A key that bounds the radius, as the drive's configuration calls it: "velocity_controller.gain".
struct RadiusBound {
  std::string key;
  std::string what;              // that is computed from it and does not fit: "mass / force constant"; empty: itself
  std::optional<double> radius;  // m, up to which or from which on it fits; none: on no radius
};

struct RadiusChoice {
  std::optional<double> radius;  // m; none: no power of two serves
  // Then why: keys that fit on no radius; and two that exclude one another, the one that needs a radius of at most its
  // own and the one that needs one of at least its own, which is larger.
  std::vector<RadiusBound> never;
  std::optional<RadiusBound> at_most, at_least;
};

// `axis`: a rotary one, described with a radius of 1 m; `timing`: of its machine.
RadiusChoice choose_radius(const Timing& timing, const AxisModel& axis);

}  // namespace stiction::machine
