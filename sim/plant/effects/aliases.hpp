// Pairs of effects that data of ordinary motion may not tell apart, with the experiment that does. The names are those
// of the whole vocabulary; a pair stands here once and is shown with both.
#pragma once

#include <array>
#include <string_view>

namespace stiction::sim {

struct AliasPair {
  std::string_view one, other;
  std::string_view separate_by;
};

inline constexpr std::string_view by_frequency_response =
    "frequency response: a delay has a phase linear in frequency, friction none, an elastic mount a step of 180 deg";
inline constexpr std::string_view by_known_mass = "accelerations at several levels, with a known added mass";

inline constexpr std::array<AliasPair, 23> alias_pairs{{
    {"constant_force", "friction_asymmetry", "turn the axis, another payload, or a reading at standstill"},
    {"mass_mismatch", "force_constant_mismatch", by_known_mass},
    {"coulomb_mismatch", "force_constant_mismatch", "a known added mass: a wrong force constant scales its force too"},
    {"viscous_mismatch", "force_constant_mismatch", "a known added mass: a wrong force constant scales its force too"},
    {"force_saturation", "force_constant_mismatch", by_known_mass},
    {"mass_mismatch", "force_saturation", by_known_mass},
    {"backlash", "presliding_hysteresis",
     "load at standstill: presliding has an elastic slope, play has none; a second encoder"},
    {"time_skew", "viscous_mismatch", by_frequency_response},
    {"time_skew", "structural_resonance", by_frequency_response},
    {"time_skew", "controller_gain_mismatch",
     "a test signal on the current: the phase of a delay grows with frequency"},
    {"viscous_mismatch", "structural_resonance", by_frequency_response},
    {"force_ripple", "encoder_subdivision_error",
     "several speeds: the force of a subdivision error grows with the speed squared, cogging does not"},
    {"force_ripple", "position_dependent_friction", "traverse the same stretch in both directions"},
    {"viscous_nonlinear", "stribeck", "more speeds below 10 mm/s"},
    {"viscous_mismatch", "thermal_drift", "several speeds at each temperature"},
    {"coulomb_mismatch", "thermal_drift", "several speeds at each temperature"},
    {"coulomb_mismatch", "presliding_hysteresis", "small reversals of several amplitudes"},
    {"mass_mismatch", "friction_lag",
     "swings about a constant speed up to high frequencies: the force of a mass grows with the frequency squared, that "
     "of a lag levels off"},
    {"time_skew", "friction_lag", by_frequency_response},
    {"position_spring", "position_dependent_friction", "traverse the same stretch in both directions"},
    {"coulomb_mismatch", "position_dependent_friction", "the whole travel at a constant speed, both ways"},
    {"force_ripple", "force_constant_ripple", "the same stretch with several accelerations and in both directions"},
    {"force_ripple", "periodic_disturbance", "a second speed, and a record at standstill"},
}};

}  // namespace stiction::sim
