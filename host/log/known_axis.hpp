// What a machine file says of the axis that a log was recorded on.
#pragma once

#include <optional>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

// A weight that turns with the axis: a moment (N m) times the sine of the angle from its rest (rad).
struct TurningWeight {
  double moment = 0.0, zero = 0.0;
};

// What is known of an axis of the machine; of a rotary one in kg m^2, N m/A, N m/V and rad.
struct KnownAxis {
  std::optional<double> mass;             // kg
  std::optional<double> force_constant;   // N/A, amplitude; N/V of a force motor
  std::optional<double> effort_limit;     // A or V of the whole axis
  std::optional<double> pole_pair_pitch;  // m
  std::optional<TurningWeight> weight;    // of a rotary axis; a constant force needs no knowledge
};

// What the file says of `axis`.
KnownAxis known_axis(const machine::AxisModel& axis);

}  // namespace stiction::host
