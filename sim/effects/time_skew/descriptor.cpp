#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"
#include "sim/effects/time_skew/time_skew.hpp"

namespace stiction::sim::effects {

EffectDescriptor time_skew() {
  return described<TimeSkew>({
      .order = 200,
      .title = "Time skew of the record",
      .meaning = "Current and position were not recorded at the same time.",
      .advice = "Correct the delay of the recorder before you identify anything else from its logs; if the delay is in "
                "the loop itself, it reduces the phase margin.",
      .aliases = {{"viscous_mismatch", experiments::frequency_response},
                  {"structural_resonance", experiments::frequency_response},
                  {"controller_gain_mismatch",
                   "a test signal on the current: the phase of a delay increases with frequency"},
                  {"friction_lag", experiments::frequency_response}},
      .abscissa = Abscissa::own_force,
      .needs = {Need::current, Need::acceleration},
      .not_in_rows = rows::no_time,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"delay", {draw.between(0.2e-3, 1e-3)}}, {"loop_delay", {0.0}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
