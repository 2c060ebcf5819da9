#include "sim/effects/describe.hpp"
#include "sim/effects/load_dependent_friction/load_dependent_friction.hpp"

namespace stiction::sim::effects {

EffectDescriptor load_dependent_friction() {
  return described<LoadDependentFriction>({
      .order = 105,
      .title = "Friction that grows with the load",
      .meaning = "Friction of a gear or screw is higher where it carries more force to the load.",
      .advice = "Enter the efficiency of the gear, or identify the coefficient from slow motion under several loads; a "
                "counterweight takes load off the gear.",
      .aliases = {},
      .abscissa = Abscissa::position,
      .needs = {Need::both_directions, Need::stroke},
      .not_in_rows = "not identifiable: a row has no load; record position and current over the stroke at a constant "
                     "speed both ways",
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"coefficient", {draw.between(0.05, 0.2)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
