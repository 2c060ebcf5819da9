// Whether the speed that a log records may take the place of the derivative of its position: where it is quieter in the
// rows of a fit, and where it is the speed of that position. A drive's speed may be scaled, filtered or late.
#pragma once

#include <string>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

struct RecordedSpeed {
  double scale = 1.0, scale_error = 0.0;  // of the recorded speed over that of the position, with its standard error
  double delay = 0.0, delay_error = 0.0;  // s, of the recorded speed behind the position
  double noise = 0.0;                     // m/s rms from sample to sample
  bool consistent = false;
  // A sentence on what speaks against its use; empty where nothing does.
  std::string objection;
};

// `channels`: of `log`, with v; `position_noise`: m rms. The speeds are compared where the position's own is quiet: up
// to the frequency at which its noise is a hundredth of the speed.
RecordedSpeed recorded_speed(const Log& log, const AxisLog& channels, double position_noise);

}  // namespace stiction::host
