// What a circle run leaves behind: one lap of both axes and the figures taken from it; of a machine with one axis that
// axis' part of the circle, a sine. SI units throughout.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace stiction::sim {

enum class Direction { counter_clockwise, clockwise };

// One axis over the evaluated lap, one sample a tick of the fast loop. Its arrays have the length of CircleRun::angle.
struct AxisLap {
  std::string axis;
  std::string friction{};             // its model; empty: that of the run
  std::vector<double> error;          // m, x_set - x at the encoder, unquantised
  std::vector<double> current;        // A, motor force / force constant
  double peak_error = 0.0;            // m, largest |error|
  double peak_error_quantised = 0.0;  // m, largest |error| as the position controller sees it
  double peak_current = 0.0;          // A, largest |current|
};

// Terms of ISO 230-4 (2022 words; the 1996 and 2005 words differ, see the report), from the encoders' signals (its
// Annex E): what the servo and friction do, not what the tool point does. All in m.
struct CircularErrors {
  double circular_error = 0.0;     // G: width of the annulus about the least-squares centre
  double radial_error_max = 0.0;   // F max: from the programmed radius about the programmed centre
  double radial_error_min = 0.0;   // F min
  std::array<double, 2> centre{};  // least-squares centre
};

// Both directions of one circle together (ISO 230-4).
struct BidirectionalErrors {
  double circular_error = 0.0;     // G(b): width of the annulus that holds both laps
  double mean_radial_error = 0.0;  // D: mean radius of both laps less the programmed radius
};

struct CircleRun {
  std::string friction;  // the model's name in the machine file, or those of the axes: "X lugre, Y classical"
  double feed = 0.0;     // m/s
  double radius = 0.0;   // m
  Direction direction = Direction::counter_clockwise;
  double sample_period = 0.0;            // s
  std::vector<double> angle;             // rad, polar angle of the set-point, counted from +X to +Y, over one lap
  std::vector<double> radial_deviation;  // m, |position| - radius
  std::vector<AxisLap> axes;  // two; one of a sine, which has no deviation from a circle and no errors of one
  CircularErrors errors;
  std::optional<BidirectionalErrors> both_directions;  // where the other direction was run too

  bool is_circle() const { return axes.size() == 2; }
  double frequency() const { return feed / (2.0 * std::numbers::pi * radius); }  // Hz, of each axis
};

struct CircleResult {
  std::string signals;  // "fixed" or "double"
  std::vector<CircleRun> runs;
};

}  // namespace stiction::sim
