#include "sim/effects/describe.hpp"
#include "sim/effects/mass_mismatch/mass_mismatch.hpp"

namespace stiction::sim::effects {

EffectDescriptor mass_mismatch() {
  return described<MassMismatch>({
      .order = 10,
      .title = "Moving mass",
      .meaning = "The accelerated mass differs from that of the machine file.",
      .advice = "Use the mass of the extended file, also in the drive if its current feedforward depends on it. Look "
                "for a workpiece, a fixture or a second carriage that the file does not contain.",
      .aliases = {{"friction_lag",
                   "oscillations about a constant speed up to high frequencies: the force of a mass increases with the "
                   "frequency "
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
