// A tuning of the friction compensation as an engineer reads it: sentences, figures, and pictures of before and after.
#pragma once

#include <utility>
#include <vector>

#include "host/tune/compensation_comparison.hpp"
#include "host/tune/compensation_tuning.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct TunedCompensations {
  machine::Machine machine;                                       // with all of them
  std::vector<std::pair<std::size_t, CompensationTuning>> tuned;  // by axis
  std::vector<ComparedCircle> circles;
  sim::CircleSettings drawn;  // the circle of the pictures
};

sim::ExperimentResult tuning_result(const TunedCompensations& all);

}  // namespace stiction::host
