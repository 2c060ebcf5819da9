// Quantizer of the position error: the nearest whole number of increments, ties away from zero
// (Mendricky 2006, Fig. 3.10). Rounding down instead of to the nearest multiple would move it by 0.5 um.
#pragma once

#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct Quantizer {
  struct Config {
    bool enabled = false;
    typename S::IncrementInverse per_metre{};  // 1 / increment
    typename S::Increment increment{};         // m
  };

  // `config`: the increment; `x`: distance, m; `saturations`: counts results that exceed the format.
  static constexpr typename S::Distance apply(const Config& config, typename S::Distance x,
                                              SaturationCounter& saturations) {
    if (!config.enabled) return x;
    const auto count = narrow<typename S::Count>(x * config.per_metre, saturations);
    return narrow<typename S::Distance>(count * config.increment, saturations);
  }
};

}  // namespace stiction
