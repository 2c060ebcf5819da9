#include "sim/effects/describe.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim::effects {

EffectDescriptor presliding_hysteresis() {
  return described<PreslidingHysteresis>({
      .order = 70,
      .title = "Presliding displacement",
      .meaning = "Before sliding, friction acts like a spring with hysteresis; it is first visible at the reversals of "
                 "a circle.",
      .advice =
          "Use the contact of the extended file. For compensation at reversals its distance is the parameter to set.",
      .aliases = {},
      .abscissa = Abscissa::since_reversal,
      .needs = {Need::small_reversals},
      .not_in_rows = "",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   const double distance = draw.between(150e-6, 500e-6), sharpness = draw.between(3.0, 8.0);
                   const double level = coulomb_of(axis.friction);
                   return {{"stiffness", {sharpness * level / distance}}, {"distance", {distance}}};
                 },
                 5},
  });
}

}  // namespace stiction::sim::effects
