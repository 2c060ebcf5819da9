// A ring of the last values of a signal, read some ticks back: whole ticks, or between two ticks by a straight line.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include "stiction/number/choice.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class Value, std::uint32_t Length>
class DelayLine {
  static_assert((Length & (Length - 1)) == 0, "DelayLine: a length that is a power of two wraps by a mask");

 public:
  static constexpr std::uint32_t length = Length;
  static constexpr std::uint32_t longest = Length - 1;  // ticks back that can be read

  constexpr void fill(const Value& value) { past_.fill(value); }
  constexpr void push(const Value& value) {
    newest_ = (newest_ + 1) & longest;
    past_[newest_] = value;
  }
  // The value `ticks` pushes before the newest, at most `longest`.
  constexpr const Value& at(std::uint32_t ticks) const { return past_[(newest_ - ticks) & longest]; }
  // The same of a batch, of which each axis has `ticks` of its own.
  template <class Ticks>
  constexpr Value at(const Ticks& ticks) const requires(!std::integral<Ticks>) {
    return from_rows(past_, newest_, ticks);
  }

 private:
  std::array<Value, Length> past_{};
  std::uint32_t newest_ = 0;
};

// The value `fraction` of the way from one to the other. It lies between them, so that it needs no test of its range.
template <class S, class Signal>
constexpr Signal between(Signal from, Signal to, typename S::TickFraction fraction) {
  return cut<Signal>(round_to<Signal>(from * S::complement(fraction) + to * fraction));
}

// The signal at `ticks` and a fraction of a tick before the newest; reads two values, the older one at ticks + 1.
// `line`: the signal's past; `ticks`: 0 to longest - 1; `fraction`: 0 to 1.
template <class S, class Signal, std::uint32_t Length>
constexpr Signal read_between(const DelayLine<Signal, Length>& line, Each<S, std::uint32_t> ticks,
                              typename S::TickFraction fraction) {
  return between<S>(line.at(ticks), line.at(ticks + 1), fraction);
}

}  // namespace stiction
