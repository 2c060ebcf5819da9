// The industry's speed pulse as well as it can be tuned at one feed: amplitude, delay and duration by a grid and four
// searches of Nelder and Mead (1965) from its best points, on the largest following error of a simulated lap. The laps
// of a round, sixteen on every processor, run at once in double precision. One feed says nothing of the characteristic
// over acceleration, so it is flat.
#pragma once

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_path.hpp"

namespace stiction::host {

struct PulseTuning {
  machine::PulseCompensationParameters pulse;
  double error_off = 0.0;  // m, without, with the firmware's signals
  double error = 0.0;      // m, with, as above
  int evaluations = 0;
};

// `machine`: with the index `axis` to tune; `circle`: on which the error is measured; `evaluations`: laps at most, and
// at least the grid and three rounds.
PulseTuning tune_pulse(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& circle,
                       int evaluations = 500);

}  // namespace stiction::host
