#include "sim/effects/describe.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim::effects {

EffectDescriptor presliding_hysteresis() {
  return described<PreslidingHysteresis>({
      .order = 70,
      .title = "Presliding displacement",
      .meaning =
          "Before it slides the axis gives way like a spring that remembers; reversals on a circle show it first.",
      .advice = "Take the extended file's contact. For compensation at reversals the distance is the one to set.",
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
