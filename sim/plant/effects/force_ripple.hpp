// A force periodic in position, independent of current: F = sum over k = 1, 2, .. of
//   cosine_k cos(2 pi k x / pitch) + sine_k sin(2 pi k x / pitch).
// Cogging of a linear motor, a bent screw, the return of the balls.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "sim/parameter.hpp"
#include "sim/plant/effects/carriage_state.hpp"
#include "sim/plant/effects/effect_values.hpp"

namespace stiction::sim {

class ForceRipple {
 public:
  struct Parameters {
    double pitch = 0.0;
    std::vector<double> cosine, sine;
  };
  static constexpr std::string_view name = "force_ripple";
  static constexpr std::string_view text = "a force periodic in position, independent of current: cogging";
  static constexpr bool several = true;
  static constexpr std::array<Parameter<Parameters>, 3> parameters{{
      {"pitch", "m", positive(), &Parameters::pitch, {}, "period of the first harmonic"},
      {"cosine", "N", any_value(), &Parameters::cosine, {}, "force in cos(2 pi k x/pitch) of harmonic k = 1, 2, .."},
      {"sine", "N", any_value(), &Parameters::sine, {}, "force in sin(2 pi k x/pitch), as many as cosine has"},
  }};
  static constexpr bool is_friction = false;

  // Throws EffectError.
  static void check(const Parameters& p) {
    if (p.sine.size() != p.cosine.size())
      throw EffectError(name, fmt::format("a list of {} as sine", p.sine.size()),
                        fmt::format("a list of {}, as many as cosine has", p.cosine.size()));
  }

  ForceRipple(const Parameters& p, Body) : p_(p), angle_per_metre_(2.0 * std::numbers::pi / p.pitch) {}

  double force(const CarriageState& s) const {
    // Harmonic k from k - 1 by rotating once more.
    const double c1 = std::cos(angle_per_metre_ * s.position), s1 = std::sin(angle_per_metre_ * s.position);
    double c = 1.0, sn = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < p_.cosine.size(); ++k) {
      const double rotated = c * c1 - sn * s1;
      sn = sn * c1 + c * s1;
      c = rotated;
      sum += p_.cosine[k] * c + p_.sine[k] * sn;
    }
    return sum;
  }

 private:
  Parameters p_;
  double angle_per_metre_;
};

}  // namespace stiction::sim
