// A cam on an elastic axis by several models side by side: how far the load swings in the dwell, and its extremes.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/cam/stand/dwell.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct StandCase {
  std::string model;  // "transfer-function"
  std::string label;
  std::vector<sim::cam::LoadState> states;
};

// The names of the models: the firmware's cascade on the simulated machine, and the two of Dostrasil 2014.
std::vector<std::string> stand_models();

// Figures and charts of `cases`, one or more, of the same `motion` at `master_speed`. `signals`: the arithmetic of the
// cascade, empty where it takes no part.
sim::ExperimentResult stand_result(const sim::cam::Motion& motion, double master_speed,
                                   const std::vector<StandCase>& cases, const std::string& signals);

// The lift with which Dostrasil 2014 compares its model with its test rig (5.4): 68.18° in 90° by a parabola, at 47
// turns a minute.
sim::cam::Cam verification_cam();
inline constexpr double verification_speed = 47.0 * 3.14159265358979323846 / 30.0;  // rad/s

}  // namespace stiction::host
