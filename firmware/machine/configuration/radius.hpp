// The radius of a rotary axis: the largest power of two at which the drive's number formats hold its configuration. The
// larger it is, the finer is a bit of its position.
#pragma once

#include <optional>
#include <string>

#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

struct RadiusChoice {
  std::optional<double> radius;  // m; none: no power of two serves
  std::string keys;              // then: the two that exclude one another, or the one that no radius serves
};

// `axis`: a rotary one, described with a radius of 1 m; `timing`: of its machine.
RadiusChoice choose_radius(const Timing& timing, const AxisModel& axis);

}  // namespace stiction::machine
