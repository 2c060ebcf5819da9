#include "sim/effects/describe.hpp"
#include "sim/effects/friction_lag/friction_lag.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor friction_lag() {
  return described<FrictionLag>({
      .order = 80,
      .title = "Friction that lags behind the speed",
      .meaning = "Friction is lower while the speed rises than while it falls.",
      .advice = "Confirm it with swings about a constant speed; then let friction feedforward follow the speed with "
                "this time.",
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
