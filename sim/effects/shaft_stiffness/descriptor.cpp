#include "sim/effects/describe.hpp"
#include "sim/effects/require_shaft.hpp"
#include "sim/effects/shaft_stiffness/shaft_stiffness.hpp"

namespace stiction::sim {

void ShaftStiffness::check_axis(const Parameters&, const machine::AxisModel& axis) { require_shaft(name, axis); }

void ShaftStiffness::change(const Parameters& p, machine::AxisModel& plant) {
  plant.transmission->stiffness = p.stiffness;
}

namespace effects {
namespace {

// N/m; of an axis without a shaft one that it refuses.
double stiffness_of(const machine::AxisModel& axis) { return axis.elastic() ? *axis.transmission->stiffness : 1e8; }

}  // namespace

EffectDescriptor shaft_stiffness() {
  return described<ShaftStiffness>({
      .order = 250,
      .title = "Stiffness of the shaft",
      .meaning = "Motor and load twist against each other by more or less than the machine file's stiffness gives.",
      .advice = "Use the stiffness of the extended file: input shaping, notches and the tuner of cams begin with it. A "
                "shaft softer than its data sheet has a loose coupling or clamp in series, or a gear that is warm.",
      .aliases =
          {{"force_constant_mismatch",
            "a known load on the axis at standstill: the twist under it knows no force constant"},
           {"mass_mismatch",
            "the same motion with a known inertia added to the load: a wrong inertia adds the same twist, a wrong "
            "stiffness a twist that is as wrong"}},
      .abscissa = Abscissa::own_force,
      .needs = {Need::second_encoder, Need::current, Need::acceleration},
      .not_in_rows = "not in two numbers per row, which know one encoder",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   return {{"stiffness", {stiffness_of(axis) * (1.0 + draw.sign() * draw.between(0.08, 0.25))}}};
                 },
                 {}},
  });
}

}  // namespace effects
}  // namespace stiction::sim
