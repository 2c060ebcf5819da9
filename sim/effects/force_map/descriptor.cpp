#include "sim/effects/describe.hpp"
#include "sim/effects/force_map/force_map.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor force_map() {
  return described<ForceMap>({
      .order = 900,
      .title = "A force without a name",
      .meaning = "A force repeats with position or velocity, and no cause of the vocabulary is as likely as that "
                 "description alone.",
      .advice = "Look at its curve: it says where or at which velocity to look at the machine. The table makes the "
                "simulation right where the records were; it says nothing of a cause.",
      .aliases = {},
      .abscissa = Abscissa::own_force,
      .needs = {Need::both_directions, Need::stroke},
      .not_in_rows = rows::no_position,
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   machine::KeyedValues values;
                   values["velocity"] = {0.0};
                   for (const double place : {-0.3, -0.1, 0.1, 0.3}) {
                     values["position"].push_back(place * axis.travel);
                     values["force"].push_back(draw.sign() * draw.between(5.0, 15.0));
                   }
                   return values;
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
