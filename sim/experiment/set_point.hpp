// Set-points in SI units and their way over the border to the drive.
#pragma once

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/drive/exchange.hpp"

namespace stiction::sim {

struct AxisSetPoint {
  double position = 0.0;      // m
  double velocity = 0.0;      // m/s
  double acceleration = 0.0;  // m/s^2
  double injection = 0.0;     // A, a test signal added to the set current
};

// Marks the set-point as not valid when one of its values is not a number or out of range.
template <class S>
SetPoint<S> to_set_point(const AxisSetPoint& set) {
  // One by one: into a part of the whole the compiler writes zeros first, which costs five instructions.
  typename S::Position position{};
  typename S::Velocity velocity{};
  typename S::Acceleration acceleration{};
  typename S::Current injection{};
  bool valid = machine::convert({set.position, set.velocity, set.acceleration}, position, velocity, acceleration);
  if (set.injection != 0.0) valid = machine::convert(set.injection, injection) && valid;
  return {position, velocity, acceleration, valid, injection};
}

}  // namespace stiction::sim
