#include "sim/effects/backlash/backlash.hpp"
#include "sim/effects/describe.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"

namespace stiction::sim {

void Backlash::check_axis(const Parameters& p, const machine::AxisModel& axis) {
  if (p.mass_ratio == 0.0) return;
  if (axis.elastic())
    throw EffectError(name, "mass_ratio on an axis with transmission.stiffness", "the gap as transmission.backlash");
  if (!effects_of<StructuralResonance>(axis).empty())
    throw EffectError(name, "mass_ratio on an axis with structural_resonance", "one of them: the plant has two masses");
}

namespace effects {

EffectDescriptor backlash() {
  return described<Backlash>({
      .order = 170,
      .title = "Lost motion (backlash)",
      .meaning = "At a reversal the motor moves while the measured position stays constant.",
      .advice = "Check the couplings, the preload of the nut and the mounting of the scale; backlash compensation "
                "hides it at low speed only.",
      .aliases = {{"presliding_hysteresis",
                   "a load at standstill: presliding has an elastic slope, backlash has none; a second encoder"}},
      .abscissa = Abscissa::since_reversal,
      .needs = {Need::set_points, Need::reversals},
      .not_in_rows = "not identifiable from two numbers per row: at a reversal it increases the largest error like a "
                     "softer contact; load the axis at standstill",
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"width", {draw.between(2e-6, 10e-6)}}};
                 },
                 {}},
  });
}

}  // namespace effects
}  // namespace stiction::sim
