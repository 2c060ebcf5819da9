// A speed that is added to the set speed (60B1h) and comes and goes by what of the change of a tick the set-point
// leaves.
#pragma once

#include "stiction/control/limit.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
class SpeedOffset {
 public:
  using Velocity = typename S::Velocity;

  // Once a tick. `wanted`: the offset that is asked for; `left`: by which it may change; below 0: not at all;
  // `saturations`: counts results that exceed the format.
  constexpr void step(Velocity wanted, Velocity left, SaturationCounter& saturations) {
    const auto most = left > Velocity{} ? left : Velocity{};
    speed_ = saturated_sum(speed_, clamped(saturated_difference(wanted, speed_, saturations), most), saturations);
  }

  constexpr Velocity speed() const { return speed_; }

 private:
  Velocity speed_{};
};

}  // namespace stiction
