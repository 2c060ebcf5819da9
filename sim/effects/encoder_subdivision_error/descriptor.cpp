#include <array>

#include "sim/effects/describe.hpp"
#include "sim/effects/encoder_subdivision_error/encoder_subdivision_error.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor encoder_subdivision_error() {
  return described<EncoderSubdivisionError>({
      .order = 190,
      .title = "Subdivision error of the encoder",
      .meaning = "The measured position has a periodic error over the signal period of the encoder.",
      .advice =
          "Clean and adjust the reading head; correct offset, amplitude and phase of its signals in the interpolator.",
      .aliases = {},
      .abscissa = Abscissa::position,
      .needs = {Need::steady_stroke, Need::slow_speeds},
      .not_in_rows = rows::no_position,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   constexpr std::array periods{20e-6, 40e-6, 100e-6};  // m
                   const double period = periods[draw.index(periods.size())];
                   return {{"period", {period}},
                           {"cosine", {draw.sign() * draw.between(0.003, 0.01) * period}},
                           {"sine", {draw.sign() * draw.between(0.003, 0.01) * period}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
