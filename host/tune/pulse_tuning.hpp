// The industry's speed pulse as well as it can be tuned at one feed: amplitude, delay and duration by a derivative-free
// optimiser (NLopt's Nelder-Mead) on the largest following error of a simulated lap. One feed says nothing of the
// characteristic over acceleration, so it is flat.
#pragma once

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_path.hpp"

namespace stiction::host {

struct PulseTuning {
  machine::PulseCompensationParameters pulse;
  double error_off = 0.0;  // m, without
  double error = 0.0;      // m, with
  int evaluations = 0;
};

// `machine`: with the index `axis` to tune; `circle`: on which the error is measured; `evaluations`: laps at most.
PulseTuning tune_pulse(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& circle,
                       int evaluations = 250);

}  // namespace stiction::host
