#include "sim/effects/controller_gain_mismatch/controller_gain_mismatch.hpp"
#include "sim/effects/describe.hpp"

namespace stiction::sim::effects {

EffectDescriptor controller_gain_mismatch() {
  return described<ControllerGainMismatch>({
      .order = 230,
      .title = "Gains of the drive",
      .meaning = "For the same set-points and positions the drive gives a different command than the controller in the "
                 "machine file.",
      .advice = "Read the gains from the drive and enter them in the machine file; check units (RMS or peak amperes, "
                "1/s or m/min/mm) before you tune again.",
      .aliases = {},
      .abscissa = Abscissa::own_force,
      .needs = {Need::set_points, Need::current, Need::acceleration},
      .not_in_rows = "not identifiable from two numbers per row: it changes the error like the contact; measure a "
                     "frequency response",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   return {{"position_gain",
                            {axis.position_controller.gain * (1.0 + draw.sign() * draw.between(0.05, 0.1))}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
