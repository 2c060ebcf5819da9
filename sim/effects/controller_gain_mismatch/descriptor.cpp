#include "sim/effects/controller_gain_mismatch/controller_gain_mismatch.hpp"
#include "sim/effects/describe.hpp"

namespace stiction::sim::effects {

EffectDescriptor controller_gain_mismatch() {
  return described<ControllerGainMismatch>({
      .order = 230,
      .title = "Gains of the drive",
      .meaning =
          "The drive commands something else than the file's controller would for the same set-points and positions.",
      .advice = "Read the gains out of the drive and put them into the machine file; look for units (RMS or peak "
                "amperes, 1/s or m/min/mm) before a new tuning.",
      .aliases = {},
      .abscissa = Abscissa::own_force,
      .needs = {Need::set_points, Need::current, Need::acceleration},
      .not_in_rows =
          "cannot be told from two numbers a row: it moves the error as the contact does; a frequency response tells",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   return {{"position_gain",
                            {axis.position_controller.gain * (1.0 + draw.sign() * draw.between(0.05, 0.1))}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
