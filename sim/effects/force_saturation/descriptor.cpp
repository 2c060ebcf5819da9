#include "sim/effects/describe.hpp"
#include "sim/effects/force_saturation/force_saturation.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor force_saturation() {
  return described<ForceSaturation>({
      .order = 160,
      .title = "Saturation of the motor",
      .meaning = "At high current the force increases less than the current.",
      .advice = "Keep accelerations below the bend of the curve, or enter the force curve of the motor in the drive.",
      .aliases = {{"force_constant_mismatch", experiments::known_mass}, {"mass_mismatch", experiments::known_mass}},
      .abscissa = Abscissa::own_force,
      .needs = {Need::current, Need::acceleration},
      .not_in_rows = "not identifiable from two numbers per row: only the fastest circle has a high current; "
                     "accelerate at several levels",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   const double limit =
                       axis.motor.driven_by_volts() ? axis.inverter.voltage_limit : axis.inverter.current_limit;
                   return {{"current", {limit * draw.between(0.7, 1.2)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
