// What the lanes of a batch do one by one, as doubles: laws that are all decisions and no arithmetic, and the library's
// sine. Compiled once, without a batch's instruction set. Arrays have `count` elements.
#pragma once

#include <cstddef>

#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/control/quadrant_learning.hpp"
#include "stiction/control/reversal_pulse.hpp"

namespace stiction::machine::lanes {

using Learning = QuadrantLearning<DoubleSignals>;
using Pulse = ReversalPulse<DoubleSignals>;

// In the place of each angle (rad) its sine.
void sines(double* values, std::size_t count);

// `configs`, `states`: `count` of each.
void start(const Learning::Config* configs, Learning::State* states, std::size_t count);
// QuadrantLearning's play(): of `dx` (m), `v` (m/s) and `a` (m/s^2) the current (A).
// `configs`, `states`: `count` of each.
void play(const Learning::Config* configs, Learning::State* states, const double* dx, const double* v, const double* a,
          double* current, std::size_t count);
// QuadrantLearning's learn() from the following error `e` (m): the `missing` current (A), and 1 where it was `dropped`.
// `configs`, `states`: `count` of each.
void learn(const Learning::Config* configs, Learning::State* states, const double* e, double* missing, double* dropped,
           std::size_t count);

// `configs`, `states`: `count` of each.
void start(const Pulse::Config* configs, Pulse::State* states, std::size_t count);
// ReversalPulse's step(): of `v` (m/s) and `a` (m/s^2) the `speed` to add (m/s).
// `configs`, `states`: `count` of each.
void step(const Pulse::Config* configs, Pulse::State* states, const double* v, const double* a, double* speed,
          std::size_t count);

}  // namespace stiction::machine::lanes
