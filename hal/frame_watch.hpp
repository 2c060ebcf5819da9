// What the frames of one node tell about its bus: lost, disturbed, drowned in others', gone. Rows of fault_table with
// Detector::backend, for any backend whose cyclic frames carry a counter and a checksum. Allocates nothing.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/drive/faults.hpp"

namespace stiction::hal {

// Of one tick.
struct FrameCounts {
  bool valid = false;           // the node's frame of this tick came, whole and in its turn
  std::uint32_t disturbed = 0;  // frames of the node that were late, twice, out of order, stale or damaged
  std::uint32_t foreign = 0;    // frames with an unknown identifier
  bool bus_off = false;         // the controller is off the bus
};

class FrameWatch {
 public:
  static constexpr int lost_allowed = 2;                  // ticks in a row
  static constexpr std::uint32_t disturbed_allowed = 10;  // within a second
  static constexpr std::uint32_t foreign_allowed = 16;    // within foreign_ticks
  static constexpr std::uint32_t foreign_ticks = 16;

  explicit constexpr FrameWatch(std::int64_t period_ns)
      : ticks_of_a_second_(static_cast<std::uint64_t>(1'000'000'000 / period_ns)) {}

  // Once a tick. What it finds stays as long as its cause does.
  constexpr Fault step(const FrameCounts& counts) {
    ++tick_;
    lost_ = counts.valid ? 0 : lost_ <= lost_allowed ? lost_ + 1 : lost_;
    // The ticks of the last disturbed frames: when the oldest of eleven is not a second back, there are too many.
    for (std::uint32_t k = 0; k < counts.disturbed && k <= disturbed_allowed; ++k) {
      newest_ = newest_ == disturbed_allowed ? 0 : newest_ + 1;
      disturbed_[newest_] = tick_;
    }
    const std::uint64_t eleventh = disturbed_[newest_ == disturbed_allowed ? 0 : newest_ + 1];
    const auto slot = static_cast<std::size_t>(tick_ % foreign_ticks);
    foreign_sum_ += counts.foreign - foreign_[slot];
    foreign_[slot] = counts.foreign;

    if (counts.bus_off) return Fault::bus_off;
    if (lost_ > lost_allowed) return Fault::frames_lost;
    if (foreign_sum_ > foreign_allowed) return Fault::bus_overload;
    if (eleventh != 0 && tick_ - eleventh < ticks_of_a_second_) return Fault::frames_disturbed;
    return Fault::none;
  }

 private:
  std::uint64_t ticks_of_a_second_;
  std::uint64_t tick_ = 0;
  int lost_ = 0;
  std::array<std::uint64_t, disturbed_allowed + 1> disturbed_{};  // ticks, a ring; 0: none yet
  std::size_t newest_ = 0;                                        // its place; the oldest comes behind it
  std::array<std::uint32_t, foreign_ticks> foreign_{};
  std::uint32_t foreign_sum_ = 0;
};

}  // namespace stiction::hal
