// What a log holds and what it can tell: sampling, speeds, reversals, saturation, and which of the machine's parameters
// its motion lets one determine. Works on the log alone; a machine's limits are optional.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

struct InspectionLimits {
  std::optional<double> max_velocity;     // m/s
  std::optional<double> current_limit;    // A of the whole axis
  std::optional<double> voltage_limit;    // V
  std::optional<double> force_constant;   // N/A, amplitude
  std::optional<double> mass;             // kg
  std::optional<double> pole_pair_pitch;  // m
};

// A stretch of constant speed.
struct SpeedPlateau {
  double speed = 0.0;     // m/s, with its sign
  double duration = 0.0;  // s, all such stretches together
};

// Samples that stand at one value at the end of the channel's range.
struct Saturation {
  std::string channel;  // "i"
  double level = 0.0;   // in the channel's unit
  double part = 0.0;    // of all samples
};

// Whether the motion lets a parameter be determined.
struct Determinable {
  const char* what;    // "Coulomb friction"
  bool possible;
  std::string reason;  // why, in this log's numbers
  std::string remedy;  // what to record instead; empty when it is possible
};

struct AxisInspection {
  std::string axis;
  double stroke = 0.0;            // m
  double max_speed = 0.0;         // m/s
  double max_acceleration = 0.0;  // m/s^2
  int reversals = 0;
  double at_rest = 0.0;  // part of the samples
  bool both_directions = false;
  std::vector<SpeedPlateau> plateaus;  // by speed
  double distinct_speed_ratio = 1.0;   // fastest to slowest magnitude among the plateaus
  double position_increment = 0.0;     // m, the grid of the measured position; 0: none found
  std::vector<Saturation> saturation;
  const LogChannel* effort = nullptr;  // i, F or u, the first that is there
  // Correlations over the moving samples; empty where the effort or the motion does not let them be told.
  std::optional<double> effort_with_direction;     // of the effort with the sign of the velocity, at steady speed
  std::optional<double> effort_with_acceleration;  // of the effort with the acceleration, friction's sign taken off
  // Where i and F both are there: N/A, and its ratio to the machine's constant.
  std::optional<double> force_per_current;
  // Where i and the machine's mass are there: N/A from the accelerations.
  std::optional<double> force_constant_from_mass;
  double set_point_delay = 0.0;  // s, of x behind x_set; 0 without x_set
  std::vector<std::string> suspicions;
  std::vector<Determinable> determinable;
};

struct Inspection {
  double duration = 0.0;  // s
  double period = 0.0;    // s
  std::vector<AxisInspection> axes;
};

// `limits`: one an axis of the log, or empty.
Inspection inspect(const Log& log, const std::vector<InspectionLimits>& limits = {});

// The measured velocity and acceleration (m/s, m/s^2) that the inspection works on: derivatives of a cubic fitted to a
// window of `seconds` around each sample. Zero-phase.
struct Motion2 {
  std::vector<double> v, a;
};
Motion2 fitted_motion(const std::vector<double>& x, double period, double seconds);

}  // namespace stiction::host
