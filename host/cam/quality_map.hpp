// The quality number of a cycle over what a search of pulses varies: place and amplitude of one, or the amplitudes of
// two. The residual is linear in the amplitudes, so the lines of one number are known in closed form.
#pragma once

#include <array>
#include <vector>

#include "sim/cam/shaping/pulses.hpp"

namespace stiction::host {

// A closed line of one number, in the units of the motion.
struct LevelLine {
  double level = 0.0;
  std::vector<std::array<double, 2>> points;
};

// The number of a residual that is `magnitude` at the end of the rise of `task`: the mean of a sine's magnitude over
// the dwell.
double quality_of_residual(const sim::cam::ShapingTask& task, double magnitude);

// Lines over place and amplitude of one pulse of `length` within the last `periods` of the rise of `task`, for shares
// of the untuned cycle's number. `running`: of the cycle that a machine comes to in its turn, and not of one from rest.
std::vector<LevelLine> map_of_one_pulse(const sim::cam::ShapingTask& task, double length, double periods,
                                        bool running = false);
// Lines over the amplitudes of two pulses where those of `where` are, for the same shares of the `task`'s number, from
// rest or `running` as above.
std::vector<LevelLine> map_of_two_pulses(const sim::cam::ShapingTask& task, const sim::cam::PulsePair& where,
                                         bool running = false);

}  // namespace stiction::host
