// An error of the measured position, periodic in the encoder's signal period: it reads y + e(y) at y, with e the sum
// over k = 1, 2, .. of cosine_k cos(2 pi k y / period) + sine_k sin(2 pi k y / period). Offsets, unequal amplitudes and
// a phase error of the scanning signals make k = 1 and 2.
#pragma once

#include <array>
#include <vector>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/harmonics.hpp"

namespace stiction::sim {

class EncoderSubdivisionError {
 public:
  struct Parameters {
    double period = 0.0;
    std::vector<double> cosine, sine;
  };
  static constexpr std::string_view name = "encoder_subdivision_error";
  static constexpr std::string_view text = "a position error periodic in the encoder's signal period";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"period", "m", machine::positive(), &Parameters::period, {}, "signal period of the encoder"},
      {"cosine", "m", machine::any_value(), &Parameters::cosine, {}, "error in cos(2 pi k x/period), k = 1, 2, .."},
      {"sine",
       "m",
       machine::any_value(),
       &Parameters::sine,
       {},
       "error in sin(2 pi k x/period), as many as cosine has"},
  }};

  // Throws EffectError.
  static void check(const Parameters& p) { Harmonics::check(name, p.cosine, p.sine); }

  explicit EncoderSubdivisionError(const Parameters& p) : error_(p.period, p.cosine, p.sine) {}

  // What is read at `position` (m) less the position, m; and its slope.
  Harmonics::Point at(double position) const { return error_.at(position); }

 private:
  Harmonics error_;
};

}  // namespace stiction::sim
