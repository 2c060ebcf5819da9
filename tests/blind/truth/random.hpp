// What a truth draws from a seed.
#pragma once

#include <cmath>
#include <random>

namespace stiction::blind {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline double log_uniform(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

}  // namespace stiction::blind
