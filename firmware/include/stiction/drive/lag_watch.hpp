// Whether the following error has been outside of its window for longer than its timeout: 6065h and 6066h of CiA 402.
#pragma once

#include <cstdint>

#include "stiction/control/limit.hpp"

namespace stiction {

template <class S>
class LagWatch {
 public:
  using Distance = typename S::Distance;

  // Once a tick; true in the tick in which it has been too long. `powered`: the axis has power, else nothing lags; `e`:
  // the following error; `window`: 0: it is not watched; `timeout_ticks`: for which it may be exceeded.
  constexpr bool step(bool powered, Distance e, Distance window, std::uint32_t timeout_ticks) {
    const bool lags = powered && window != Distance{} && exceeds(e, window);
    const bool too_long = lags && ticks_ >= timeout_ticks;
    ticks_ = lags && !too_long ? ticks_ + 1 : 0;
    return too_long;
  }

 private:
  std::uint32_t ticks_ = 0;
};

}  // namespace stiction
