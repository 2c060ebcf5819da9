#include "sim/effects/describe.hpp"
#include "sim/effects/position_spring/position_spring.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor position_spring() {
  return described<PositionSpring>({
      .order = 120,
      .title = "Force proportional to position",
      .meaning = "A force proportional to position acts like a spring: cable carrier, bellows or hose.",
      .advice = "Move the axis by hand over its stroke with and without cable carrier and covers; use the stiffness of "
                "the extended file.",
      .aliases = {{"position_dependent_friction", "the same segment in both directions"}},
      .abscissa = Abscissa::position,
      .needs = {Need::stroke, Need::both_directions},
      .not_in_rows = rows::no_position,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"stiffness", {draw.between(80.0, 250.0)}}, {"neutral", {draw.between(-0.05, 0.05)}}};
                 },
                 6},
  });
}

}  // namespace stiction::sim::effects
