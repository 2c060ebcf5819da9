// What a log holds and what it can tell: sampling, speeds, reversals, saturation, and which of the machine's parameters
// its motion lets one determine. Works on the log alone; what is known of the machine makes it say more.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/log/known_axis.hpp"
#include "host/log/limits.hpp"
#include "host/log/log.hpp"
#include "host/log/questions.hpp"

namespace stiction::host {

// Stretches of constant speed: within 1 % over at least 0.1 s and 0.1 mm.
struct SpeedPlateau {
  double speed = 0.0;     // m/s, with its sign
  double duration = 0.0;  // s, all such stretches together
};

// A channel that stands still at the end of its range.
struct Saturation {
  std::string channel;  // "i"
  double level = 0.0;   // in the channel's unit
  double part = 0.0;    // of all samples
};

// Whether the motion lets something be determined.
struct Determinable {
  std::string what;  // the title of an effect
  bool possible = false;
  std::string reason;  // in this log's numbers
  std::string remedy;  // what to record instead; empty when it is possible
};

// Least squares of the effort: mass·a + viscous·v + coulomb·sgn v + offset, over the samples that move. In the unit of
// the effort (A, N or V) per SI unit; the standard errors count one independent sample in 10 ms.
struct RigidFit {
  std::vector<double> value = std::vector<double>(4), error = std::vector<double>(4);  // mass, viscous, coulomb, offset
  std::vector<double> inflation = std::vector<double>(4);  // of each one's variance by the others (VIF); 1: none
  double residual = 0.0;                                   // rms, of the effort
};

// The increment that a channel was written with and the noise that rides on it, in its unit; 0: none found.
struct ChannelResolution {
  const LogChannel* channel = nullptr;
  double increment = 0.0, noise = 0.0;
};

struct AxisInspection {
  std::string axis;
  double stroke = 0.0;            // m
  double max_speed = 0.0;         // m/s
  double max_acceleration = 0.0;  // m/s^2
  int reversals = 0;
  double at_rest = 0.0;                // part of the samples
  double forward = 0.0;                // part of the moving samples that go in +x
  std::vector<SpeedPlateau> plateaus;  // by speed
  std::vector<Saturation> saturation;
  const LogChannel* effort = nullptr;         // i, F or u, the first that is there
  std::optional<RigidFit> fit;                // none: too few moving samples, or a stroke within presliding
  std::optional<double> force_per_current;    // N/A, where F and i are both there
  std::optional<double> force_constant;       // N per unit of effort, from the accelerations and the known mass
  std::optional<double> delay;                // s, of x behind x_set; none without x_set
  std::vector<ChannelResolution> resolution;  // of each channel that is there
  std::vector<LimitedChannel> limited;        // channels that stand at an end of their range
  double left_out = 0.0;                      // part of the samples that no fit may use
  std::vector<Question> questions;            // to be answered before any result
  std::string only_a_ratio;                   // what the log gives only as a ratio; empty: nothing
  std::vector<std::string> suspicions;
  std::vector<Determinable> determinable;
};

struct Inspection {
  double duration = 0.0;  // s
  std::vector<AxisInspection> axes;
};

// `known`: one an axis of the log, or empty.
Inspection inspect(const Log& log, const std::vector<KnownAxis>& known = {});

// Velocity and acceleration (m/s, m/s^2) of measured positions: derivatives of the quadratic fitted to 10 ms around
// each sample (at least five samples), without delay.
struct FittedMotion {
  std::vector<double> v, a;
};
FittedMotion fitted_motion(const std::vector<double>& x, double period);

}  // namespace stiction::host
