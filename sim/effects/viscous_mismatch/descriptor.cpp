#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"
#include "sim/effects/viscous_mismatch/viscous_mismatch.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim::effects {

EffectDescriptor viscous_mismatch() {
  return described<ViscousMismatch>({
      .order = 30,
      .title = "Slope of viscous friction",
      .meaning = "The slope of friction over speed differs from that of the machine file.",
      .advice =
          "Use the slope of the extended file. Compare a cold and a warm machine: the lubricant is the usual cause.",
      .aliases = {{"structural_resonance", experiments::frequency_response},
                  {"thermal_drift", "several speeds at each temperature"}},
      .abscissa = Abscissa::speed,
      .needs = {Need::speeds},
      .not_in_rows = "",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   const double slope = viscous_of(axis.friction);
                   return {{"viscous", {slope * (1.0 + draw.sign() * draw.between(0.1, 0.3))}}};
                 },
                 2},
  });
}

}  // namespace stiction::sim::effects
