#include "sim/effects/coulomb_mismatch/coulomb_mismatch.hpp"
#include "sim/effects/describe.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim::effects {

EffectDescriptor coulomb_mismatch() {
  return described<CoulombMismatch>({
      .order = 20,
      .title = "Level of Coulomb friction",
      .meaning = "The level of friction that does not depend on speed differs from that of the machine file.",
      .advice = "Use the level of the extended file. It varies by 2 to 4 % from day to day; a larger change indicates "
                "preload, lubrication or wipers.",
      .aliases = {{"thermal_drift", "several speeds at each temperature"},
                  {"presliding_hysteresis", "small reversals of several amplitudes"},
                  {"position_dependent_friction", "the whole travel at a constant speed in both directions"}},
      .abscissa = Abscissa::speed,
      .needs = {Need::friction_level},
      .not_in_rows = "",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   const double level = coulomb_of(axis.friction);
                   return {{"coulomb", {level * (1.0 + draw.sign() * draw.between(0.08, 0.2))}}};
                 },
                 1},
  });
}

}  // namespace stiction::sim::effects
