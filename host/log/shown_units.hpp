// How quantities that were computed on the linear axis are shown: in the usual units of the axis itself.
#pragma once

#include <numbers>

#include "firmware/machine/model/coordinate.hpp"

namespace stiction::host {

// A value in SI units of the linear axis, shown: times `factor`, in `unit`.
struct ShownQuantity {
  double factor = 1.0;
  const char* unit = "";
  const char* key = unit;  // how names of figures spell it

  double operator()(double linear) const { return linear * factor; }
};

struct ShownUnits {
  ShownQuantity position{1e3, "mm"}, deviation{1e6, "um"};
  ShownQuantity slow{1e3, "mm/s"}, feed{60.0, "m/min", "m_per_min"}, speed{1.0, "m/s"};
  ShownQuantity acceleration{1.0, "m/s^2"};
  ShownQuantity force{1.0, "N"};
  const char* force_word = "force";

  ShownUnits() = default;  // of a linear axis
  explicit ShownUnits(const machine::Coordinate& coordinate) {
    if (!coordinate.rotary()) return;
    const double radians = 1.0 / coordinate.radius, degrees = 180.0 / std::numbers::pi * radians;
    position = {degrees, "deg"};
    deviation = {1e6 * radians, "urad"};
    slow = feed = {degrees, "deg/s", "deg_per_s"};
    speed = {radians, "rad/s"};
    acceleration = {radians, "rad/s^2"};
    force = {coordinate.radius, "N m"};
    force_word = "torque";
  }
};

}  // namespace stiction::host
