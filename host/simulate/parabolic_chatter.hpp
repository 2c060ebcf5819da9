// Why the parabolic friction B2 chatters in the source's impact test (Mendricky 2006, 6.2: about +-15 N): its slope at
// standstill is infinite, and friction evaluated explicitly, at the velocity of the step before, throws that velocity
// over its sign. From v = h F(v) / (2 m), with F = a v^(1/n), the alternation has the amplitude
//   F = a^(n/(n-1)) (h / 2m)^(1/(n-1)).
// It belongs to the step h, not to the machine: the implicit step of sim/plant/friction/parabolic.hpp has none.
#pragma once

#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/experiment_result.hpp"
#include "sim/plant/friction/parabolic.hpp"

namespace stiction::host {

// Amplitude (N) of the alternation of a free mass (kg) at steps of `step` (s). Friction of order n > 1. `friction`: its
// a and n.
double chatter_amplitude(const sim::ParabolicParameters& friction, double mass, double step);

// The last half of a second, long after the impact.
struct ChatterRun {
  double least = 0.0, greatest = 0.0;  // N, of the friction
  double rms = 0.0;                    // N
  double alternating = 0.0;            // share of the evaluations at which the friction changed its sign
  sim::Series friction;                // N over ms since its beginning, a stretch of it
};

// The impact of `force` (N) at `time` (s) on the machine's only axis, firmware in fixed point, with its parabolic
// friction evaluated explicitly every `step` (s, at least a tick) and held; without a step, implicitly by the plant.
// Throws FaultTripped.
ChatterRun impact_with_parabolic_friction(machine::Machine machine, double force, double time,
                                          std::optional<double> step);

}  // namespace stiction::host
