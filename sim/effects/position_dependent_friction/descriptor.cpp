#include "sim/effects/describe.hpp"
#include "sim/effects/position_dependent_friction/position_dependent_friction.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor position_dependent_friction() {
  return described<PositionDependentFriction>({
      .order = 90,
      .title = "Friction that varies along the stroke",
      .meaning = "Friction is higher at some positions than at others, in both directions.",
      .advice = "Inspect these positions: misaligned guide, dry or dirty segment, screw with varying preload, cover "
                "that binds. A table over position compensates it.",
      .aliases = {},
      .abscissa = Abscissa::position,
      .needs = {Need::both_directions, Need::stroke},
      .not_in_rows = rows::no_position,
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   machine::KeyedValues values;
                   for (const double place : {-0.3, -0.1, 0.1, 0.3}) {
                     values["position"].push_back(place * axis.travel);
                     values["force"].push_back(draw.sign() * draw.between(5.0, 15.0));
                   }
                   return values;
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
