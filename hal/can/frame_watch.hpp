// Judges the frames of one node against the ticks: which one is the answer to this tick, which ones are late, twice,
// out of order, stale or damaged, and when that is a fault (fault_table: frames lost, frames disturbed).
#pragma once

#include <cstdint>

#include "stiction/drive/faults.hpp"

namespace stiction::hal::can {

struct FrameCounts {
  std::uint64_t good = 0;
  std::uint64_t lost = 0;          // ticks without an answer
  std::uint64_t late = 0;          // the answer to the tick before
  std::uint64_t duplicate = 0;     // a second answer to this tick
  std::uint64_t out_of_order = 0;  // of neither this tick nor the one before
  std::uint64_t stale = 0;         // of this tick's number, but on the bus before the tick began
  std::uint64_t damaged = 0;       // wrong checksum
  std::uint64_t bad() const { return late + duplicate + out_of_order + stale + damaged; }
};

class FrameWatch {
 public:
  static constexpr int lost_allowed = 2;  // ticks in a row; the next one is a fault
  static constexpr int bad_allowed = 10;  // frames a second

  // `frames`: that make an answer. `counter_mask`: the bits of the tick that a frame carries.
  FrameWatch(std::size_t frames, std::uint32_t counter_mask, std::uint32_t ticks_a_second)
      : all_((1u << frames) - 1u), mask_(counter_mask), second_(ticks_a_second) {}

  // A tick begins, `began_ns` on the clock of the time stamps.
  void begin(std::uint32_t tick, std::int64_t began_ns) {
    tick_ = tick;
    began_ns_ = began_ns;
    seen_ = 0;
    if (++ticks_ % second_ == 0) bad_this_second_ = 0;
  }

  // A frame, `part` of the answer, with its counter. True: it is this tick's, to be used.
  bool take(unsigned part, std::uint32_t counter, std::int64_t received_ns) {
    const std::uint32_t behind = (tick_ - counter) & mask_;
    const std::uint32_t bit = 1u << part;
    if (behind == 1) return refuse(counts_.late);
    if (behind != 0) return refuse(counts_.out_of_order);
    if ((seen_ & bit) != 0) return refuse(counts_.duplicate);
    if (received_ns < began_ns_) return refuse(counts_.stale);
    seen_ |= bit;
    if (complete()) ++counts_.good;
    return true;
  }
  void take_damaged() { refuse(counts_.damaged); }

  bool complete() const { return seen_ == all_; }

  // The tick's answers have had their time.
  void end() {
    if (complete()) {
      lost_in_a_row_ = 0;
    } else {
      ++counts_.lost;
      if (lost_in_a_row_ <= lost_allowed) ++lost_in_a_row_;
    }
  }

  Fault fault() const {
    if (lost_in_a_row_ > lost_allowed) return Fault::frames_lost;
    return bad_this_second_ > bad_allowed ? Fault::frames_disturbed : Fault::none;
  }
  const FrameCounts& counts() const { return counts_; }

 private:
  bool refuse(std::uint64_t& count) {
    ++count;
    ++bad_this_second_;
    return false;
  }

  unsigned all_;
  std::uint32_t mask_;
  std::uint32_t second_;
  std::uint32_t tick_ = 0;
  std::int64_t began_ns_ = 0;
  unsigned seen_ = 0;
  std::uint64_t ticks_ = 0;
  int lost_in_a_row_ = 0;
  int bad_this_second_ = 0;
  FrameCounts counts_;
};

}  // namespace stiction::hal::can
