// What the equations of a spring, a mass and a step of friction say without integration: the jump of a feed drive
// (Kudoyarov et al., (1), and its terms for damping and speed) and the feed above which it does not jump. `beta` is the
// feed v sqrt(c m) / dF, dF the step of friction, `zeta` the damping ratio.
#pragma once

#include "sim/plant/feed/stick_slip_feed.hpp"

namespace stiction::sim {

// Travel of one jump over 2 dF/c at small beta: (1 + exp(-pi zeta / sqrt(1 - zeta^2))) / 2 + beta pi/2.
double small_feed_jump_ratio(double beta, double zeta);

// beta above which an ideal drive does not jump: the speed of the carriage after break-away, a decaying oscillation
// about the feed that begins at zero, just touches zero again. 0 < zeta < 1. (For small zeta 1/sqrt(4 pi zeta), the
// energy balance of the textbooks.)
double critical_beta(double zeta);

// The feed, m/s, above which the drive with constant static friction, moved at constant speed, does not jump.
double critical_feed_of_ideal_drive(const machine::FeedDrive& drive);

// Whether the motor's loops come to rest, with the carriage standing and with the spring free.
bool loops_are_stable(const machine::FeedDrive& drive);

// A cycle of steady jumping.
struct JumpCycle {
  double travel = 0.0;          // m, of the jump
  double period = 0.0;          // s, from start to start
  double slip_time = 0.0;       // s
  double dwell = 0.0;           // s
  double break_away_force = 0;  // N
};

// Whether the drive from standstill keeps jumping at `feed`; if it does, the mean of its cycles after the start has
// died out.
struct Jumping {
  bool lasts = false;
  JumpCycle cycle;
};
// `drive`: parameters; `source`: ideal or controlled motor; `equations`: as printed or corrected; `feed`: m/s, above 0;
// `accuracy`: tolerance and largest step.
Jumping jumping_at(const machine::FeedDrive& drive, FeedSource source, FeedEquations equations, double feed,
                   FeedAccuracy accuracy = {});

// The feed, m/s, above which the simulated drive with the corrected equations stops jumping, by bisection to
// `relative`. Zero when it does not even jump at a hundredth of the ideal drive's critical feed, infinite when it still
// does at a hundred times that. `drive`: parameters; `source`: ideal or controlled motor; `relative`: accuracy of the
// result, 1e-4 for instance.
double critical_feed_by_bisection(const machine::FeedDrive& drive, FeedSource source, double relative);

}  // namespace stiction::sim
