// Coloured noise of the truth plant: what sensors and the world add, with spectra that fall with frequency.
// Gauss-Markov processes (first-order, exact in discrete time): variance s^2, corner frequency f, x+ = e^(-2 pi f h) x
// + ...
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace stiction::blind {

class GaussMarkov {
 public:
  // `rms` in the signal's unit, `corner` in Hz; drawn every `step` s. Begins anywhere in its distribution.
  GaussMarkov(double rms, double corner, double step, std::uint64_t seed) : random_(seed) {
    decay_ = std::exp(-2.0 * std::numbers::pi * corner * step);
    drive_ = rms * std::sqrt(1.0 - decay_ * decay_);
    value_ = rms * normal_(random_);
  }
  double next() {
    value_ = decay_ * value_ + drive_ * normal_(random_);
    return value_;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double decay_ = 0.0, drive_ = 0.0, value_ = 0.0;
};

// Of one log. 0: none of it.
struct NoiseLevels {
  double slow_force = 0.0;         // N rms on the carriage
  double slow_force_corner = 2.0;  // Hz
  double fast_force = 0.0;         // N rms on the carriage
  double fast_force_corner = 40.0;
  double encoder = 0.0;        // m rms
  double phase_current = 0.0;  // A rms, of a phase's sensor
};

}  // namespace stiction::blind
