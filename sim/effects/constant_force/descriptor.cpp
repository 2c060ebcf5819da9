#include "sim/effects/constant_force/constant_force.hpp"
#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor constant_force() {
  return described<ConstantForce>({
      .order = 110,
      .title = "Constant force",
      .meaning = "A constant force acts on the axis: weight, counterbalance or an offset of the current sensor.",
      .advice = "Read the current at standstill with the drive off: that is the offset of the sensor. The remainder is "
                "weight: check the counterbalance.",
      .aliases = {{"friction_asymmetry", "the axis turned over, a different payload, or a reading at standstill",
                   Separable::not_by_motion}},
      .abscissa = Abscissa::velocity,
      .needs = {Need::offset},
      .not_in_rows = rows::both_directions,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"force", {draw.sign() * draw.between(6.0, 15.0)}}};
                 },
                 8},
  });
}

}  // namespace stiction::sim::effects
