// Every signal of every tick, kept in memory that is there before the loop starts and written as a log after it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "stiction/drive/axis_signals.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::drive {

class Trace {
 public:
  // Room for `ticks`; what comes after them is not kept.
  Trace(std::size_t axes, std::size_t ticks) : axes_(axes), signals_(axes * ticks), times_ns_(ticks) {}

  void add(std::int64_t since_start_ns, std::span<const AxisSignals<FixedSignals>> signals) {
    if (used_ == times_ns_.size()) return;
    std::copy(signals.begin(), signals.end(), signals_.begin() + static_cast<std::ptrdiff_t>(used_ * axes_));
    times_ns_[used_++] = since_start_ns;
  }

  // A log as docs/formats.md describes it. Throws std::runtime_error when it cannot be written. `file`: to write;
  // `axes`: their names, in the order of the loop; `comments`: leading lines "key: value".
  void write(const std::filesystem::path& file, const std::vector<std::string>& axes,
             std::span<const std::string> comments) const;

 private:
  std::size_t axes_;
  std::size_t used_ = 0;
  std::vector<AxisSignals<FixedSignals>> signals_;
  std::vector<std::int64_t> times_ns_;
};

}  // namespace stiction::drive
