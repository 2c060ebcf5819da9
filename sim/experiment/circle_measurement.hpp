// Measures a circle: collects the evaluated lap and takes peaks and circular errors (ISO 230-4) from it. Of one axis
// alone the peaks.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::sim {

// One axis in one tick. SI units.
struct CircleAxisSample {
  double position = 0.0;    // m, as the encoder reads it
  double error = 0.0;       // m, unquantised
  double error_held = 0.0;  // m, as the position controller holds it
  double current = 0.0;     // A (V of a force source), motor force / force constant
};

class CircleMeasurement {
 public:
  // `settings`: the circle that is driven; `sample_period`: s, between calls of add(); `axes`: names of one or two
  // axes.
  CircleMeasurement(const CircleSettings& settings, double sample_period, const std::vector<std::string>& axes);

  // Takes a tick, of each axis; those outside of the evaluated lap are passed over.
  void add(const CirclePath::Point& set, const std::array<CircleAxisSample, 2>& axes);

  // The finished run, without the friction model's name. Throws std::logic_error when the lap is empty.
  CircleRun finish() const;

 private:
  CircleRun run_;
};

// Terms of one lap. `angle` (rad) and `radial_deviation` (m) have the same length.
CircularErrors circular_errors(const std::vector<double>& angle, const std::vector<double>& radial_deviation);

// Terms of both laps of one circle, each about the programmed centre and radius.
BidirectionalErrors bidirectional_errors(const CircleRun& a, const CircleRun& b);

}  // namespace stiction::sim
