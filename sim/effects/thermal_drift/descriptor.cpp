#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"
#include "sim/effects/thermal_drift/thermal_drift.hpp"

namespace stiction::sim::effects {

EffectDescriptor thermal_drift() {
  return described<ThermalDrift>({
      .order = 100,
      .title = "Friction that drifts as the machine warms up",
      .meaning = "The level of friction changes from the start of the record, or of the session, on.",
      .advice = "Warm up before precise work. Identify friction cold and warm and compare with the viscosity of the "
                "lubricant.",
      .aliases = {},
      .abscissa = Abscissa::time,
      .needs = {Need::long_record},
      .not_in_rows = rows::no_time,
      .hidden =
          {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
             return {{"change", {draw.sign() * draw.between(8.0, 20.0)}}, {"time_constant", {draw.between(4.0, 15.0)}}};
           },
           {}},
  });
}

}  // namespace stiction::sim::effects
