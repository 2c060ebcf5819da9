#include "sim/effects/describe.hpp"
#include "sim/effects/friction_lag/friction_lag.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor friction_lag() {
  return described<FrictionLag>({
      .order = 80,
      .title = "Friction that lags behind the speed",
      .meaning = "Friction is lower while the speed increases than while it decreases.",
      .advice = "Confirm it with oscillations about a constant speed; then filter the speed of the friction "
                "feedforward with this time constant.",
      .aliases = {},
      .abscissa = Abscissa::speed,
      .needs = {Need::speeds, Need::acceleration},
      .not_in_rows = rows::no_time,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"time", {draw.between(8e-3, 20e-3)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
