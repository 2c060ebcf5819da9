// The sentence at the head of the circle's report: what the run shows, computed from its figures.
#pragma once

#include <string>
#include <string_view>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

struct CircleFinding {
  std::string sentence;  // plain text
  double feed = 0.0;     // m/s, the feed it speaks of
};

// Speaks of the model that acts according to the machine file (of all models when that one was not run), at the middle
// one of the measured feeds (of all feeds when none was measured): the source matched its friction there. Throws
// std::invalid_argument when the result has no run.
CircleFinding circle_finding(const sim::CircleResult& result, const machine::Machine& machine);

// What people call a model, "C LuGre" for "lugre"; the name itself for a model that the table does not have.
std::string friction_label(std::string_view name);

}  // namespace stiction::host
