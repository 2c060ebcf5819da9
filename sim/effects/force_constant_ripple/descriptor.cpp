#include <array>

#include "sim/effects/describe.hpp"
#include "sim/effects/force_constant_ripple/force_constant_ripple.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor force_constant_ripple() {
  return described<ForceConstantRipple>({
      .order = 140,
      .title = "Ripple of the force constant",
      .meaning = "The force per ampere varies periodically with position.",
      .advice = "Compare the pitch with the pole-pair pitch of the magnets: half of it indicates current sensors of "
                "unequal gain, a sixth an EMF that is not sinusoidal, the whole or more unequal magnets.",
      .aliases = {},
      .abscissa = Abscissa::position,
      .needs = {Need::current, Need::acceleration, Need::steady_stroke},
      .not_in_rows = rows::no_position,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   constexpr std::array pitches{0.072, 0.036, 0.024, 0.012};  // m
                   return {{"pitch", {pitches[draw.index(pitches.size())]}},
                           {"cosine", {draw.sign() * draw.between(0.03, 0.06)}},
                           {"sine", {draw.sign() * draw.between(0.02, 0.05)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
