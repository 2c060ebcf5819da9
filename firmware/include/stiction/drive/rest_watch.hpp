// Whether an axis is at rest, by the way that it makes and not by a speed: 50 nm of noise are 1 mm/s in a tick, and a
// coarse encoder stands still for most ticks.
#pragma once

#include <cstdint>

namespace stiction {

template <class S>
class RestWatch {
 public:
  using Position = typename S::Position;

  // For which an axis that is at rest has been within the way.
  static constexpr std::uint8_t ticks = 64;

  constexpr void start(Position measured) { rested_at_ = measured; }

  // Once a tick. `measured`: position; `way`: that an axis at rest may make.
  constexpr void step(Position measured, Position way) {
    const auto made = measured.raw() - rested_at_.raw();
    if (made > way.raw() || made < -way.raw()) {
      rested_at_ = measured;
      ticks_ = 0;
    } else if (ticks_ < ticks) {
      ++ticks_;
    }
  }

  constexpr bool at_rest() const { return ticks_ == ticks; }

 private:
  Position rested_at_{};
  std::uint8_t ticks_ = 0;
};

}  // namespace stiction
