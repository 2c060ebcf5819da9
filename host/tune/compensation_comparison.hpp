// What each compensation leaves of the error on simulated circles: off, the speed pulse, the friction feedforward, and
// with learning.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_path.hpp"

namespace stiction::host {

struct ComparedCircle {
  CompensationKind kind = CompensationKind::off;
  double feed = 0.0;                 // m/s
  std::vector<double> peak_error;    // m, of each axis over the last lap, |x_set - x| unquantised
  std::vector<double> peak_current;  // A, of each axis over all laps
  bool dropped = false;              // what was learned was dropped on an axis
  // Of the feed that is drawn: the last lap, by the angle from +x (rad), in equal steps.
  std::vector<double> angle;
  std::vector<std::vector<double>> error;  // m, of each axis at these angles
};

struct ComparisonSettings {
  sim::CircleSettings circle;      // radius; its feed is the one that is drawn
  std::vector<double> feeds;       // m/s
  int learning_laps = 4;           // before the one that counts
  std::function<void()> progress;  // after each circle
};

// `machine`: with the compensations of its axes; an axis without one of a kind runs without it. Axes run alone.
// Circles that the machine cannot drive are left out. Throws FaultTripped.
std::vector<ComparedCircle> compare_compensations(const machine::Machine& machine, const ComparisonSettings& settings);
std::size_t compared_circles(const machine::Machine& machine, const ComparisonSettings& settings);

const char* name_of(CompensationKind kind);  // as a machine file has it
const char* words_of(CompensationKind kind);

}  // namespace stiction::host
