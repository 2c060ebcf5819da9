// A force periodic in position and proportional to the current: of the motor's force F = K_F i the carriage gets
//   F (1 + sum over k = 1, 2, .. of cosine_k cos(2 pi k x / pitch) + sine_k sin(2 pi k x / pitch)).
// Magnets or windings that differ from pole to pole, an EMF that is no sine: what the current does not show.
#pragma once

#include <array>
#include <vector>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"
#include "sim/effects/harmonics.hpp"

namespace stiction::sim {

class ForceConstantRipple {
 public:
  struct Parameters {
    double pitch = 0.0;
    std::vector<double> cosine, sine;
  };
  static constexpr std::string_view name = "force_constant_ripple";
  static constexpr std::string_view text = "a force periodic in position, proportional to current";
  static constexpr bool several = true;
  static constexpr machine::Range share{-0.9, 0.9};
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"pitch", "m", machine::positive(), &Parameters::pitch, {}, "period of the first harmonic"},
      {"cosine", "1", share, &Parameters::cosine, {}, "share of the force in cos(2 pi k x/pitch), k = 1, 2, .."},
      {"sine", "1", share, &Parameters::sine, {}, "share of the force in sin(2 pi k x/pitch), as many as cosine has"},
  }};
  static constexpr bool is_friction = false;

  // Throws EffectError.
  static void check(const Parameters& p) { Harmonics::check(name, p.cosine, p.sine); }

  ForceConstantRipple(const Parameters& p, Body) : ripple_(p.pitch, p.cosine, p.sine) {}

  double force(const CarriageState& s) const { return s.motor_force * ripple_.at(s.position).value; }

 private:
  Harmonics ripple_;
};

}  // namespace stiction::sim
