#include "sim/effects/describe.hpp"
#include "sim/effects/shared_sentences.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"

namespace stiction::sim {

void StructuralResonance::check_axis(const Parameters& p, const machine::AxisModel& axis) {
  if (axis.elastic() && p.motor_measured == 0)
    throw EffectError(name, "motor_measured = 0 on an axis with transmission.stiffness",
                      "motor_measured = 1, a part of the load behind the rest of it");
}

namespace effects {

EffectDescriptor structural_resonance() {
  return described<StructuralResonance>({
      .order = 180,
      .title = "Elastic mode",
      .meaning = "An elastic part between motor and encoder oscillates (coupling, screw or mount), or a body behind "
                 "both does.",
      .advice = "Set a notch at its frequency or reduce the velocity gain; make jerk times multiples of its period; "
                "stiffen the joint, or measure closer to the motor.",
      .aliases = {},
      .abscissa = Abscissa::own_force,
      .needs = {Need::acceleration},
      .not_in_rows = rows::no_time,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"frequency", {draw.between(120.0, 300.0)}},
                           {"damping_ratio", {draw.between(0.1, 0.3)}},
                           {"mass_ratio", {draw.between(0.3, 0.8)}}};
                 },
                 {}},
  });
}

}  // namespace effects
}  // namespace stiction::sim
