#include "sim/effects/describe.hpp"
#include "sim/effects/master_delay/master_delay.hpp"

namespace stiction::sim::effects {

EffectDescriptor master_delay() {
  return described<MasterDelay>({
      .order = 240,
      .title = "Slave behind its master",
      .meaning = "The slave follows its master late: what it should do at a time of the master it does a while after.",
      .advice = "Let the drive look ahead by the delay (its estimator of the master extrapolates), or compensate the "
                "bus' dead time in the controller; check that the cam is evaluated after its master in each cycle.",
      .aliases =
          {{"controller_gain_mismatch",
            "the same cam at a different speed of the master: a delay shifts more of the motion the faster it is"},
           {"time_skew", "a test signal on the current: the loop answers it without the master's delay"}},
      .abscissa = Abscissa::own_force,
      .needs = {Need::master, Need::set_points, Need::current, Need::acceleration},
      .not_in_rows = "not in two numbers per row, which know no master",
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"delay", {draw.between(0.25e-3, 2e-3)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
