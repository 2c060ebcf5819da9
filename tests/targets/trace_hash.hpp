// Digests of the trace: one a signal over the whole run, and one a tick over all signals, so that a difference can be
// named by signal and by tick. FNV-1a, 64 bits, over the signal's raw word.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "stiction/drive/axis.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/targets/compensation.hpp"
#include "tests/targets/hash.hpp"

namespace stiction::targets {

// Calls visit(name, word) for all that an axis shows of itself in a tick.
template <class Visit>
void each_word(const AxisSignals<FixedSignals>& s, const Axis<FixedSignals>& axis,
               const CompensationBeside& compensation, Visit&& visit) {
  for_each_signal(s, [&](const char* name, auto, auto, auto value) { visit(name, std::int64_t{value.raw()}); });
  visit("limiting_velocity", std::int64_t{s.limiting.velocity});
  visit("limiting_current", std::int64_t{s.limiting.current});
  visit("limiting_voltage", std::int64_t{s.limiting.voltage});
  visit("fault", static_cast<std::int64_t>(s.fault));
  visit("saturations", static_cast<std::int64_t>(axis.state().saturations.count));
  compensation.each_word(visit);
}

// The hash of every signal of one axis.
class TraceHash {
 public:
  // Returns the digest of this tick.
  std::uint64_t add(const AxisSignals<FixedSignals>& s, const Axis<FixedSignals>& axis,
                    const CompensationBeside& compensation) {
    Hash tick;
    std::size_t i = 0;
    each_word(s, axis, compensation, [&](const char* name, std::int64_t word) {
      names_[i] = name;
      signals_[i++].add(word);
      tick.add(word);
    });
    count_ = i;
    return tick.value();
  }

  // print(text) gets "AXIS.SIGNAL HASH\n" in pieces.
  template <class Print>
  void report(std::size_t axis, Print&& print) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const std::array<char, 3> prefix{static_cast<char>('0' + axis), '.', '\0'};
      print(prefix.data());
      print(names_[i]);
      std::array<char, 19> text{" "};
      for (std::size_t digit = 0; digit < 16; ++digit)
        text[1 + digit] = "0123456789abcdef"[(signals_[i].value() >> (60 - 4 * digit)) & 15];
      text[17] = '\n';
      print(text.data());
    }
  }

 private:
  static constexpr std::size_t capacity = 48;
  std::array<const char*, capacity> names_{};
  std::array<Hash, capacity> signals_{};
  std::size_t count_ = 0;
};

}  // namespace stiction::targets
