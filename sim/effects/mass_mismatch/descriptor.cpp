#include "sim/effects/describe.hpp"
#include "sim/effects/mass_mismatch/mass_mismatch.hpp"

namespace stiction::sim::effects {

EffectDescriptor mass_mismatch() {
  return described<MassMismatch>({
      .order = 10,
      .title = "Moving mass",
      .meaning = "The axis accelerates another mass than the machine file says.",
      .advice = "Take the extended file's mass; set it in the drive too, where the current feedforward uses it. Look "
                "for a workpiece, a fixture or a second carriage that the file does not know.",
      .aliases = {{"friction_lag",
                   "swings about a constant speed up to high frequencies: the force of a mass grows with the frequency "
                   "squared, that of a lag levels off"}},
      .abscissa = Abscissa::acceleration,
      .needs = {Need::acceleration},
      .not_in_rows = "",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   return {{"mass", {axis.mass * (1.0 + draw.sign() * draw.between(0.02, 0.06))}}};
                 },
                 0},
  });
}

}  // namespace stiction::sim::effects
