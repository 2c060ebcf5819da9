// The methods against residual vibration, a row each: what a method needs to know, and the lift that it makes.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "sim/cam/shaping/task.hpp"

namespace stiction::sim::cam {

struct ShapingMethod {
  std::string_view name;   // "zvd"
  std::string_view label;  // for readers
  std::string_view needs;  // what it has to know
  // The lift over the rise, or none where the rise or the dwell is too short for it.
  std::optional<Curve> (*lift)(const ShapingTask& task);
};

// All of them; the first one leaves the motion as it is.
std::span<const ShapingMethod> shaping_methods();
const ShapingMethod* find_shaping_method(std::string_view name);

struct ShapedMotion {
  const ShapingMethod* method = nullptr;
  Cam cam;
  Motion motion;
  BandFigures from_rest;  // at five frequencies over the band
  BandFigures running;    // the same where the residual of the cycle before is still there
  double speed = 0.0;     // peaks over time, of the slave
  double acceleration = 0.0;
  double jerk = 0.0;                // its finite part
  double acceleration_ratio = 0.0;  // of the parabola's over the same rise
  double rise = 0.0;                // of the master, until the set-point rests
};

// What the `method` makes of a `task`; none where it has no room.
std::optional<ShapedMotion> shaped(const ShapingTask& task, const ShapingMethod& method);

}  // namespace stiction::sim::cam
