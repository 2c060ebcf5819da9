#include "sim/effects/describe.hpp"
#include "sim/effects/stribeck/stribeck.hpp"

namespace stiction::sim::effects {

EffectDescriptor stribeck() {
  return described<Stribeck>({
      .order = 50,
      .title = "Stribeck effect",
      .meaning = "Friction decreases with speed near standstill.",
      .advice = "Use the curve of the extended file. Against stick-slip: lubricant with friction modifier, lower "
                "preload, a stiffer velocity loop.",
      .aliases = {},
      .abscissa = Abscissa::speed,
      .needs = {Need::slow_speeds},
      .not_in_rows = "not found: the rows of steady friction rise from the lowest speed on; they have no information "
                     "about lower speeds",
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"break_away", {draw.between(20.0, 40.0)}}, {"velocity", {draw.between(4e-3, 12e-3)}}};
                 },
                 4},
  });
}

}  // namespace stiction::sim::effects
