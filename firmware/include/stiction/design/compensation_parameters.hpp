// The parameters of the friction compensation in SI units, under the names that they have in a machine file; A is V
// with a force source. Lists are views: what they show must outlive the parameters.
#pragma once

#include <cstdint>
#include <span>

namespace stiction::design {

// Speed pulse at reversals, its amplitude over the acceleration there.
struct PulseCompensationParameters {
  double amplitude = 0.0;        // m/s
  double final_amplitude = 0.0;  // m/s
  double rise_until = 0.0;       // m/s^2, a1
  double flat_until = 0.0;       // m/s^2, a2
  double fall_until = 0.0;       // m/s^2, a3
  double delay = 0.0;            // s, from the reversal of the newest set-point
  double duration = 0.0;         // s; 0: no pulse
};

// Current against friction from the set-points: presliding by distance, a sliding curve by speed.
struct FrictionFeedforwardParameters {
  double look_ahead = 0.0;                        // s, by which the current comes before the set-point
  std::span<const double> distance{};             // m after a reversal at which each element slips again; at most 8
  std::span<const double> level{};                // A of each element; their sum is the Coulomb level
  double contact_damping = 0.0;                   // s
  std::span<const double> speed{};                // m/s, increasing
  std::span<const double> forward{}, backward{};  // A beyond the Coulomb level at these speeds, in +v and in -v

  constexpr bool given() const { return look_ahead > 0.0 || !distance.empty() || !speed.empty(); }
};

// How the drive learns from the errors of earlier laps.
struct QuadrantLearningParameters {
  double gain = 0.0;        // of what was missing, per lap
  double forgetting = 0.0;  // share per lap
  double smoothing = 0.0;   // share of each neighbour per lap
  double limit = 0.0;       // A
  double dead_zone = 0.0;   // m
  double filter = 0.0;      // s; 0: nothing is learned
  double lead = -1.0;       // s, from a force to the error it makes; below 0: learning_lead() finds it
  // What was learned before, currents (A) at the 23 nodes over the way since a reversal, and by whom: a table of a
  // different identity is refused.
  std::span<const double> learned_forward{}, learned_backward{};
  std::uint32_t identity = 1, learned_identity = 1;
};

}  // namespace stiction::design
