// A sum of harmonics over a length: f(x) = sum over k = 1, 2, .. of
//   cosine_k cos(2 pi k x / period) + sine_k sin(2 pi k x / period).
#pragma once

#include <fmt/format.h>

#include <numbers>
#include <string_view>
#include <vector>

#include "sim/effects/effect_values.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim {

class Harmonics {
 public:
  // `period` (m) above 0; as many sines as cosines. `cosine` and `sine`: amplitudes.
  Harmonics(double period, std::vector<double> cosine, std::vector<double> sine)
      : angle_per_metre_(2.0 * std::numbers::pi / period), cosine_(std::move(cosine)), sine_(std::move(sine)) {}

  // Throws EffectError in the name of `effect`. `cosine` and `sine`: amplitudes.
  static void check(std::string_view effect, const std::vector<double>& cosine, const std::vector<double>& sine) {
    if (sine.size() != cosine.size())
      throw EffectError(effect, fmt::format("a list of {} as sine", sine.size()),
                        fmt::format("a list of {}, as many as cosine has", cosine.size()));
  }

  struct Point {
    double value = 0.0;
    double slope = 0.0;  // per metre
  };
  // Harmonic k from k - 1 by rotating once more.
  Point at(double x) const {
    const auto [s1, c1] = sine_cosine(angle_per_metre_ * x);
    double c = 1.0, s = 0.0;
    Point sum;
    for (std::size_t k = 0; k < cosine_.size(); ++k) {
      const double rotated = c * c1 - s * s1;
      s = s * c1 + c * s1;
      c = rotated;
      sum.value += cosine_[k] * c + sine_[k] * s;
      sum.slope += static_cast<double>(k + 1) * angle_per_metre_ * (sine_[k] * c - cosine_[k] * s);
    }
    return sum;
  }

 private:
  double angle_per_metre_;
  std::vector<double> cosine_, sine_;
};

}  // namespace stiction::sim
