#include "sim/effects/describe.hpp"
#include "sim/effects/friction_asymmetry/friction_asymmetry.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor friction_asymmetry() {
  return described<FrictionAsymmetry>({
      .order = 60,
      .title = "Friction differs between directions",
      .meaning = "Friction is higher in one direction than in the other.",
      .advice = "Turn the axis over or read the current at standstill to separate it from a constant force; then look "
                "for a wiper, a cover or a misalignment that acts in one direction.",
      .aliases = {},
      .abscissa = Abscissa::velocity,
      .needs = {Need::both_directions},
      .not_in_rows = rows::both_directions,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"coulomb", {0.0}}, {"viscous", {draw.sign() * draw.between(40.0, 100.0)}}};
                 },
                 9},
  });
}

}  // namespace stiction::sim::effects
