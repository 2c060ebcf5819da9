// Judges the frames of one node against the ticks: which one is the answer to this tick, and which ones are late,
// twice, out of order, stale or damaged. When that is a fault says hal::FrameWatch.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stiction::hal::can {

struct AnswerCounts {
  std::uint64_t good = 0;
  std::uint64_t lost = 0;          // ticks without an answer
  std::uint64_t late = 0;          // the answer to the tick before
  std::uint64_t duplicate = 0;     // a second answer to this tick
  std::uint64_t out_of_order = 0;  // of neither this tick nor the one before
  std::uint64_t stale = 0;         // of this tick's number, but on the bus before the tick began
  std::uint64_t damaged = 0;       // wrong checksum
  std::uint64_t bad() const { return late + duplicate + out_of_order + stale + damaged; }
};

class AnswerCheck {
 public:
  // `frames`: that make an answer. `counter_mask`: the bits of the tick that a frame carries.
  AnswerCheck(std::size_t frames, std::uint32_t counter_mask) : all_((1u << frames) - 1u), mask_(counter_mask) {}

  // A tick begins, `began_ns` on the clock of the time stamps.
  void begin(std::uint32_t tick, std::int64_t began_ns) {
    tick_ = tick;
    began_ns_ = began_ns;
    seen_ = 0;
    bad_ = 0;
  }

  // A frame, `part` of the answer, with its counter. True: it is this tick's, to be used. `counter`: low bits of its
  // tick; `received_ns`: its time stamp, on the clock of begin().
  bool take(unsigned part, std::uint32_t counter, std::int64_t received_ns) {
    const std::uint32_t behind = (tick_ - counter) & mask_;
    const std::uint32_t bit = 1u << part;
    if (behind == 1) return refuse(counts_.late);
    if (behind != 0) return refuse(counts_.out_of_order);
    if ((seen_ & bit) != 0) return refuse(counts_.duplicate);
    if (received_ns < began_ns_) return refuse(counts_.stale);
    seen_ |= bit;
    return true;
  }
  void take_damaged() { refuse(counts_.damaged); }

  bool complete() const { return seen_ == all_; }

  // The tick's answers have had their time.
  void end() { ++(complete() ? counts_.good : counts_.lost); }

  std::uint32_t bad_in_tick() const { return bad_; }
  const AnswerCounts& counts() const { return counts_; }

 private:
  bool refuse(std::uint64_t& count) {
    ++count;
    ++bad_;
    return false;
  }

  unsigned all_;
  std::uint32_t mask_;
  std::uint32_t tick_ = 0;
  std::int64_t began_ns_ = 0;
  unsigned seen_ = 0;
  std::uint32_t bad_ = 0;
  AnswerCounts counts_;
};

}  // namespace stiction::hal::can
