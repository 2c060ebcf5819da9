#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"
#include "tests/effects/made_up/end_cushion/end_cushion.hpp"

namespace stiction::sim::effects {

EffectDescriptor end_cushion() {
  return described<EndCushion>({
      .order = 1000,
      .title = "Cushion at the end of the travel",
      .meaning = "Before the end of its travel the axis meets an elastic cushion.",
      .advice = "Inspect the buffer of the end stop.",
      .aliases = {{"position_spring", "the same segment with and without the part before the cushion"}},
      .abscissa = Abscissa::position,
      .needs = {Need::stroke},
      .not_in_rows = rows::no_position,
      .hidden =
          {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
             return {{"begin", {draw.between(0.0, 0.1) * axis.travel}}, {"stiffness", {draw.between(3000.0, 6000.0)}}};
           },
           {}},
  });
}

}  // namespace stiction::sim::effects
