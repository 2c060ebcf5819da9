// The timing rule of friction compensation, automated: a path that goes inside first and then outside says that the
// compensation comes too early, outside first and then inside too late (Heidenhain MANUALplus, commissioning of
// compTimeOffset). A current that comes late by d lacks d times its rate; the position loop turns this into an error
// whose shape is known from its gains. How much of the shape is in the error after each reversal is d.
#pragma once

#include <string_view>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct TimingError {
  double late = 0.0;            // s; negative: the current comes too early
  double standard_error = 0.0;  // s, from the scatter over the reversals
  int reversals = 0;            // that were judged

  // "too early", "too late", or "in time" where twice the standard error, or a quarter of `tick` s, holds it.
  std::string_view verdict(double tick) const;
};

// `log`: of a motion with reversals, driven with the compensation of `machine` (friction or learning), with x_set and x
// at the drive's rate or a few of its ticks. `axis`: index in the machine. Throws LogError when nothing can be judged.
TimingError timing_of(const Log& log, const machine::Machine& machine, std::size_t axis);

}  // namespace stiction::host
