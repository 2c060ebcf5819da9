// Counts the edges of an incremental encoder's two tracks. Two tracks a quarter of a period apart go through four
// states in Gray code: one track changes at each step, and which one says the direction (any text on incremental
// encoders; here A leads B in the positive direction: 00, 10, 11, 01). Both tracks changing at once is no step: a
// disturbance, or an edge that was lost.
#pragma once

#include <array>
#include <cstdint>

namespace stiction::hal {

class QuadratureDecoder {
 public:
  enum class Step : std::uint8_t { none, forward, backward, illegal };

  constexpr QuadratureDecoder() = default;
  constexpr QuadratureDecoder(bool a, bool b) : state_(state(a, b)) {}

  // The levels of the tracks from `time_ns` on. An illegal step leaves the count as it was. `a`, `b`: whether each
  // track is high.
  constexpr Step set(bool a, bool b, std::int64_t time_ns) {
    const unsigned to = state(a, b);
    const Step step = steps[4 * state_ + to];
    state_ = to;
    if (step == Step::none) return step;
    last_edge_ns_ = time_ns;
    if (step == Step::forward) ++count_;
    if (step == Step::backward) --count_;
    if (step == Step::illegal) ++illegal_;
    return step;
  }

  constexpr std::int64_t count() const { return count_; }                // edges forward less edges backward
  constexpr std::int64_t last_edge_ns() const { return last_edge_ns_; }  // 0: none yet
  constexpr std::uint64_t illegal() const { return illegal_; }           // steps of both tracks at once
  constexpr bool a() const { return (state_ & 2u) != 0; }
  constexpr bool b() const { return (state_ & 1u) != 0; }

 private:
  static constexpr unsigned state(bool a, bool b) { return (a ? 2u : 0u) | (b ? 1u : 0u); }
  static constexpr auto n = Step::none, f = Step::forward, r = Step::backward, x = Step::illegal;
  // Row: from AB = 00, 01, 10, 11; column: to.
  static constexpr std::array<Step, 16> steps{n, r, f, x, f, n, x, r, r, x, n, f, x, f, r, n};

  unsigned state_ = 0;
  std::int64_t count_ = 0;
  std::int64_t last_edge_ns_ = 0;
  std::uint64_t illegal_ = 0;
};

}  // namespace stiction::hal
