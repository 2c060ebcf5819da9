// 1 - exp(-a) for the steps of relaxing states, where it takes a large part of a simulation's time.
#pragma once

#include <cmath>

namespace stiction::sim {

// For a >= 0, relative error below 6e-8 (at the limit of the series; 2e-10 at a third of it).
// That is less than what the step itself leaves. Steps are short, so a is small most of the time: there the series is.
inline double one_minus_exp(double a) {
  if (a > 0.125) [[unlikely]]
    return -std::expm1(-a);
  constexpr double c2 = -1.0 / 2, c3 = 1.0 / 6, c4 = -1.0 / 24, c5 = 1.0 / 120;
  return a * (1.0 + a * (c2 + a * (c3 + a * (c4 + a * c5))));
}

}  // namespace stiction::sim
