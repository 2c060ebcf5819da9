// What holds for every log that a reader of host/log hands out.
#pragma once

#include <cmath>

#include "host/log/log.hpp"
#include "tests/fuzz/machine_bytes.hpp"

namespace stiction::fuzz {

inline void check_promises(const host::Log& log) {
  if (log.t.size() < 2 || log.axes.empty() || !(log.period > 0.0)) finding("too little was accepted");
  for (std::size_t k = 0; k < log.t.size(); ++k) {
    if (!std::isfinite(log.t[k])) finding("a time is not finite");
    if (k > 0 && !(log.t[k] > log.t[k - 1])) finding("the time does not rise");
  }
  for (const auto& axis : log.axes) {
    if (axis.x.empty() || (axis.i.empty() && axis.force.empty() && axis.u.empty())) finding("a channel is missing");
    for (const auto& channel : host::log_channels) {
      const auto& values = axis.*channel.values;
      if (!values.empty() && values.size() != log.t.size()) finding("a channel has another length");
      std::size_t blank = 0;  // a cell without value
      for (const double value : values) {
        blank += std::isnan(value);
        if (std::isinf(value)) finding("a value is not finite");
      }
      if (!values.empty() && blank == values.size()) finding("a channel has no value");
    }
  }
}

}  // namespace stiction::fuzz
