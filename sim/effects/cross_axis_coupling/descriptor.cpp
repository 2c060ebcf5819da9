#include "sim/effects/cross_axis_coupling/cross_axis_coupling.hpp"
#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor cross_axis_coupling() {
  return described<CrossAxisCoupling>({
      .order = 210,
      .title = "Coupling with the other axis",
      .meaning = "The acceleration of the other axis exerts a force on this one.",
      .advice = "Check squareness and the position of the centre of mass of the load; use the set acceleration of the "
                "other axis as feedforward.",
      .aliases = {},
      .abscissa = Abscissa::acceleration,
      .needs = {Need::other_axis},
      .not_in_rows = rows::no_time,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"mass", {draw.sign() * draw.between(3.0, 8.0)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
