// Every signal of every tick, kept in memory that is there before the loop starts and written as a log after it.
#pragma once

#include <algorithm>
#include <atomic>
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

  // `since_start_ns`: time of the tick; `signals`: of the axes; `origin(i)`: of the machine's coordinates, which the
  // trace is in, in those of the encoder.
  template <class Origin>
  void add(std::int64_t since_start_ns, std::span<const AxisSignals<FixedSignals>> signals, Origin origin) {
    const std::size_t used = rows();
    if (used == times_ns_.size()) {
      lost_.store(lost() + 1, std::memory_order_relaxed);
      return;
    }
    for (std::size_t i = 0; i < signals.size(); ++i) {
      auto& kept = signals_[used * axes_ + i];
      kept = signals[i];
      kept.x = FixedSignals::Position::from_raw(kept.x.raw() - origin(i).raw());
      kept.x_set = FixedSignals::Position::from_raw(kept.x_set.raw() - origin(i).raw());
    }
    times_ns_[used] = since_start_ns;
    used_.store(used + 1, std::memory_order_relaxed);
  }

  // By any thread.
  std::size_t rows() const { return used_.load(std::memory_order_relaxed); }    // that were kept
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }  // that found no room

  // A log as docs/formats.md describes it. Throws std::runtime_error when it cannot be written. `file`: to write;
  // `axes`: their names, in the order of the loop; `comments`: leading lines "key: value".
  void write(const std::filesystem::path& file, const std::vector<std::string>& axes,
             std::span<const std::string> comments) const;

 private:
  std::size_t axes_;
  std::atomic<std::size_t> used_ = 0;
  std::atomic<std::uint64_t> lost_ = 0;
  std::vector<AxisSignals<FixedSignals>> signals_;
  std::vector<std::int64_t> times_ns_;
};

}  // namespace stiction::drive
