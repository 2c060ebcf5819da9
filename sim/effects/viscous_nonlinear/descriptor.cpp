#include "sim/effects/describe.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"

namespace stiction::sim::effects {

EffectDescriptor viscous_nonlinear() {
  return described<ViscousNonlinear>({
      .order = 40,
      .title = "Viscous friction that is not linear",
      .meaning = "Friction does not increase in proportion to speed.",
      .advice = "Use the curve of the extended file, or choose a friction law that is not linear; record more speeds "
                "where it bends.",
      .aliases = {{"stribeck", "more speeds below 10 mm/s"}},
      .abscissa = Abscissa::speed,
      .needs = {Need::many_speeds},
      .not_in_rows = "",
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"force", {draw.between(15.0, 30.0)}}, {"velocity", {draw.between(0.02, 0.08)}}};
                 },
                 3},
  });
}

}  // namespace stiction::sim::effects
