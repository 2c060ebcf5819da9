// The one table of effects. A new effect is one header beside this one (name, text, keys, physics) and its row here:
// the machine file's reader and reference page, the plant and the diagnosis take everything from it.
//
// What an effect's physics may be:
//   static void change(const Parameters&, Axis&)             the plant's own parameters; the drive keeps the file's
//   class with force(const CarriageState&), is_friction      a force on the carriage in each step (N, positive in +x);
//                                                            with advance(const CarriageState&), one that remembers
//   Backlash, EncoderSubdivisionError, TimeSkew::delay       what is measured and recorded
//   ForceSaturation, StructuralResonance                     between motor and carriage
//   CrossAxisCoupling                                        a force by the other axis
//   static void change_drive(const Parameters&, Axis&)       the drive's parameters; the plant keeps the file's
// Changes are made in the order of the table, whatever the order in the file.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "sim/plant/effects/backlash.hpp"
#include "sim/plant/effects/constant_force.hpp"
#include "sim/plant/effects/controller_gain_mismatch.hpp"
#include "sim/plant/effects/coulomb_mismatch.hpp"
#include "sim/plant/effects/cross_axis_coupling.hpp"
#include "sim/plant/effects/effect_kind.hpp"
#include "sim/plant/effects/effect_values.hpp"
#include "sim/plant/effects/encoder_subdivision_error.hpp"
#include "sim/plant/effects/force_constant_mismatch.hpp"
#include "sim/plant/effects/force_constant_ripple.hpp"
#include "sim/plant/effects/force_ripple.hpp"
#include "sim/plant/effects/force_saturation.hpp"
#include "sim/plant/effects/friction_asymmetry.hpp"
#include "sim/plant/effects/friction_lag.hpp"
#include "sim/plant/effects/mass_mismatch.hpp"
#include "sim/plant/effects/periodic_disturbance.hpp"
#include "sim/plant/effects/position_dependent_friction.hpp"
#include "sim/plant/effects/position_spring.hpp"
#include "sim/plant/effects/presliding_hysteresis.hpp"
#include "sim/plant/effects/stribeck.hpp"
#include "sim/plant/effects/structural_resonance.hpp"
#include "sim/plant/effects/thermal_drift.hpp"
#include "sim/plant/effects/time_skew.hpp"
#include "sim/plant/effects/viscous_mismatch.hpp"
#include "sim/plant/effects/viscous_nonlinear.hpp"

namespace stiction::sim {

using EffectTable =
    std::tuple<MassMismatch, CoulombMismatch, ViscousMismatch, ViscousNonlinear, Stribeck, FrictionAsymmetry,
               PreslidingHysteresis, FrictionLag, PositionDependentFriction, ThermalDrift, ConstantForce,
               PositionSpring, ForceRipple, ForceConstantRipple, ForceConstantMismatch, ForceSaturation, Backlash,
               StructuralResonance, EncoderSubdivisionError, TimeSkew, CrossAxisCoupling, PeriodicDisturbance,
               ControllerGainMismatch>;

// Calls visit.operator()<E>() for each effect of the table, in order.
template <class Visit, std::size_t Index = 0>
constexpr void for_each_effect(Visit&& visit) {
  if constexpr (Index < std::tuple_size_v<EffectTable>) {
    visit.template operator()<std::tuple_element_t<Index, EffectTable>>();
    for_each_effect<Visit, Index + 1>(static_cast<Visit&&>(visit));
  }
}

// Every effect with its keys and aliases, in the order of the table.
std::span<const EffectKind> effect_kinds();

// The tables of keys, for whoever opens a machine file.
std::vector<machine::ValueTable> effect_tables();

// nullptr for a name that is none.
const EffectKind* find_effect_kind(std::string_view name);

// Throws EffectError for an unknown name and for values that parameters_of() refuses.
void check_effect(const machine::Effect& effect);

// "N s/m" as the suffix of a name in verdict.json: "_N_s_per_m"; empty for "1".
std::string unit_suffix(std::string_view unit);

// All effects of kind E that an axis has. Throws EffectError.
template <class E>
std::vector<typename E::Parameters> effects_of(const machine::AxisModel& axis) {
  std::vector<typename E::Parameters> found;
  for (const machine::Effect& effect : axis.effects)
    if (effect.name == E::name) found.push_back(parameters_of<E>(effect));
  return found;
}

// The axis as its plant is: with the changes of its effects made. The drive's configuration comes from `axis` itself.
// Throws EffectError for an unknown effect, for one too many, for values that parameters_of() refuses and for those
// that do not go with the friction model in use.
machine::AxisModel plant_axis(const machine::AxisModel& axis);

// The axis as its drive is configured: with the changes of those effects that are the drive's. Throws EffectError.
machine::AxisModel drive_axis(const machine::AxisModel& axis);

// By which the current of this axis is recorded late against its position, s.
double record_delay(const machine::AxisModel& axis);

}  // namespace stiction::sim
