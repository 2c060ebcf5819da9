#include "sim/effects/describe.hpp"
#include "sim/effects/force_constant_mismatch/force_constant_mismatch.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor force_constant_mismatch() {
  return described<ForceConstantMismatch>({
      .order = 150,
      .title = "Force constant or current scale",
      .meaning = "The force of the motor per ampere differs from that of the machine file, or the current is recorded "
                 "on a different scale.",
      .advice = "First check peak against RMS amperes and the scale of the recorder, then the data sheet and the "
                "temperature of the motor; a known added mass separates it from mass and friction.",
      .aliases = {{"mass_mismatch", experiments::known_mass, Separable::not_as_this_one},
                  {"coulomb_mismatch", "a known added mass: a wrong force constant scales its force as well",
                   Separable::not_as_this_one},
                  {"viscous_mismatch", "a known added mass: a wrong force constant scales its force as well",
                   Separable::not_as_this_one}},
      .abscissa = Abscissa::own_force,
      .needs = {Need::current, Need::acceleration},
      .not_in_rows = "not identifiable from two numbers per row: it scales mass and friction together; accelerate a "
                     "known added mass",
      .hidden =
          {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
             return {{"force_constant", {axis.motor.force_constant * (1.0 + draw.sign() * draw.between(0.03, 0.06))}}};
           },
           {}},
  });
}

}  // namespace stiction::sim::effects
