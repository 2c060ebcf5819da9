// What a p-value can mean at most, as odds against chance.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiction::host {

// The largest Bayes factor that a p-value `p` can have against the null hypothesis, whatever the alternative (Sellke,
// Bayarri, Berger, Am. Stat. 55, 2001): 1 / (-e p ln p); from p = 1/e on 1.
inline double most_odds(double p) {
  p = std::clamp(p, 1e-300, 1.0 / std::numbers::e);
  return -1.0 / (std::numbers::e * p * std::log(p));
}

}  // namespace stiction::host
