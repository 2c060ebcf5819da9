// A force periodic in position, independent of current: F = sum over k = 1, 2, .. of
//   cosine_k cos(2 pi k x / pitch) + sine_k sin(2 pi k x / pitch).
// Cogging of a linear motor, a bent screw, the return of the balls.
#pragma once

#include <array>
#include <vector>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"
#include "sim/effects/harmonics.hpp"

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
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"pitch", "m", machine::positive(), &Parameters::pitch, {}, "period of the first harmonic"},
      {"cosine",
       "N",
       machine::any_value(),
       &Parameters::cosine,
       {},
       "force in cos(2 pi k x/pitch) of harmonic k = 1, 2, .."},
      {"sine", "N", machine::any_value(), &Parameters::sine, {}, "force in sin(2 pi k x/pitch), as many as cosine has"},
  }};
  static constexpr bool is_friction = false;

  // Throws EffectError.
  static void check(const Parameters& p) { Harmonics::check(name, p.cosine, p.sine); }

  ForceRipple(const Parameters& p, Body) : ripple_(p.pitch, p.cosine, p.sine) {}

  double force(const CarriageState& s) const { return ripple_.at(s.position).value; }

 private:
  Harmonics ripple_;
};

}  // namespace stiction::sim
