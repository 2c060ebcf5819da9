#include "sim/effects/coulomb_mismatch/coulomb_mismatch.hpp"
#include "sim/effects/describe.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim::effects {

EffectDescriptor coulomb_mismatch() {
  return described<CoulombMismatch>({
      .order = 20,
      .title = "Level of Coulomb friction",
      .meaning = "The friction that does not depend on speed is another one.",
      .advice = "Take the extended file's level. It moves by 2 to 4 % from day to day; more points to preload, "
                "lubrication or wipers.",
      .aliases = {{"thermal_drift", "several speeds at each temperature"},
                  {"presliding_hysteresis", "small reversals of several amplitudes"},
                  {"position_dependent_friction", "the whole travel at a constant speed, both ways"}},
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
