// Pulses from the quality number of a cycle alone: no record, no frequency.
// The square of the number is a quadratic form in the amplitudes of two pulses: four cycles tell about where its
// minimum is, and three are there, each by all before. For comparison, the searches of Dostrasil 2014 (6.4) for place
// and amplitude of a single pulse: the simplexes of Nelder and Mead, and halving of an interval along one axis after
// the other.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "sim/cam/shaping/record_tuner.hpp"

namespace stiction::sim::cam {

// The quality number of a cycle with a cam: the area of the load's deviation in the dwell, in any unit. None: that
// cycle has not been run yet.
using CycleQuality = std::function<std::optional<double>(const Cam& cam)>;

struct SearchTrial {
  std::array<double, 2> at{};  // amplitudes of two pulses, or place and amplitude of one
  double quality = 0.0;
};

struct NumberSearch {
  std::vector<SearchTrial> trials;
  Cam best;                          // with the least number
  SearchTrial least;                 // its
  std::optional<Cam> next;           // of the cycle that has not been run yet
  std::optional<PulsePair> where{};  // of two pulses, where they are
};

// Two pulses of a `task` by the quadratic form, in seven cycles; `settings` have the limits, and in the unit of
// `quality` nothing.
NumberSearch search_by_quadratic_form(const ShapingTask& task, const TunerSettings& settings,
                                      const CycleQuality& quality);

// Three places and amplitudes that are no line.
using Simplex = std::array<std::array<double, 2>, 3>;

// One pulse of a `task` over `length` of the master, from `start` in so many `steps`, by the `quality` of cycles; a
// pulse beyond the rise is moved into it.
NumberSearch search_by_simplex(const ShapingTask& task, double length, const Simplex& start, int steps,
                               const CycleQuality& quality);
// The three that a search begins with where nothing is known: in the last period before the end of the rise of `task`,
// with pulses of `length`.
Simplex first_simplex(const ShapingTask& task, double length);

// One pulse of a `task` over `length`, by `sweeps` over place and amplitude, each halved five times, by the
// `quality` of cycles.
NumberSearch search_by_halving(const ShapingTask& task, double length, int sweeps, const CycleQuality& quality);

}  // namespace stiction::sim::cam
