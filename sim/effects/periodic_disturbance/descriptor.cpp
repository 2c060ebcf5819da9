#include "sim/effects/describe.hpp"
#include "sim/effects/periodic_disturbance/periodic_disturbance.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor periodic_disturbance() {
  return described<PeriodicDisturbance>({
      .order = 220,
      .title = "Disturbance at a fixed frequency",
      .meaning = "A force oscillates at a frequency that does not depend on the motion.",
      .advice = "At standstill switch off pumps, fans and the spindle one after another and watch the line in the "
                "spectrum. Balance or isolate its source.",
      .aliases = {},
      .abscissa = Abscissa::own_force,
      .needs = {Need::seconds},
      .not_in_rows = rows::no_time,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"frequency", {draw.between(6.0, 45.0)}},
                           {"cosine", {draw.sign() * draw.between(4.0, 10.0)}},
                           {"sine", {draw.sign() * draw.between(2.0, 8.0)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
