#include "host/report/cause_text.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace stiction::host {
namespace {

struct Row {
  std::string_view effect, title, meaning, advice;
};
constexpr std::array rows{
    Row{"mass_mismatch", "Moving mass", "The axis accelerates another mass than the machine file says.",
        "Take the extended file's mass; set it in the drive too, where the current feedforward uses it. Look for a "
        "workpiece, a fixture or a second carriage that the file does not know."},
    Row{"coulomb_mismatch", "Level of Coulomb friction", "The friction that does not depend on speed is another one.",
        "Take the extended file's level. It moves by 2 to 4 % from day to day; more points to preload, lubrication or "
        "wipers."},
    Row{"viscous_mismatch", "Slope of viscous friction", "Friction grows with speed at another rate.",
        "Take the extended file's slope. Compare a cold and a warm machine: lubricant is its usual cause."},
    Row{"viscous_nonlinear", "Viscous friction that bends", "Friction does not grow in proportion to speed.",
        "Take the extended file's curve, or choose a friction model with one; record more speeds where it bends."},
    Row{"stribeck", "Stribeck effect", "Friction falls with speed near standstill.",
        "Take the extended file's curve. Against stick-slip: lubricant with friction modifier, lower preload, a "
        "stiffer "
        "velocity loop."},
    Row{"friction_asymmetry", "Friction differs between directions", "The axis runs heavier in one direction.",
        "Turn the axis or take a reading at standstill to tell it from a constant force; then look for a wiper, a "
        "cover "
        "or a misalignment that acts in one direction."},
    Row{"presliding_hysteresis", "Presliding displacement",
        "Before it slides the axis gives way like a spring that remembers; reversals on a circle show it first.",
        "Take the extended file's contact. For compensation at reversals the distance is the one to set."},
    Row{"friction_lag", "Friction that lags behind the speed",
        "Friction is lower while the speed rises than while it falls.",
        "Confirm it with swings about a constant speed; then let friction feedforward follow the speed with this "
        "time."},
    Row{"position_dependent_friction", "Friction that varies along the stroke",
        "The axis runs heavier in some places than in others, in both directions.",
        "Look at the place: guide out of line, a dry or dirty stretch, a screw with changing preload, a cover that "
        "binds. A table over position compensates it."},
    Row{"thermal_drift", "Friction that drifts as the machine warms up",
        "The level of friction changes from the record's start on.",
        "Warm up before precise work. Identify friction cold and warm and compare the lubricant's viscosity."},
    Row{"constant_force", "Constant force", "A force that is always there: weight, counterbalance, current offset.",
        "Read the current at standstill with the drive off: what remains is the sensor's offset. The rest is weight: "
        "check the counterbalance."},
    Row{"position_spring", "Force proportional to position",
        "Something pulls like a spring: cable carrier, bellows, hose.",
        "Move it by hand over its stroke with and without cable carrier and covers; take the extended file's "
        "stiffness."},
    Row{"force_ripple", "Force ripple (cogging)",
        "A force that repeats with the position and does not depend on current.",
        "Compare the pitch with the magnets' pole pitch and the screw's lead. Most drives have a cogging compensation: "
        "pitch, amplitudes and phases are its parameters."},
    Row{"force_constant_ripple", "Ripple of the force constant",
        "The force per ampere changes periodically with the position.",
        "Compare the pitch with the magnets' pole-pair pitch: half of it points to current sensors of unequal gain, a "
        "sixth to an EMF that is no sine, the whole or more to unequal magnets."},
    Row{"force_constant_mismatch", "Force constant or current scale",
        "The motor gives another force per ampere, or the current is recorded on another scale.",
        "Check peak against RMS amperes and the recorder's scale first, then the motor's data sheet and temperature; "
        "weigh a known mass to tell it from mass and friction."},
    Row{"force_saturation", "Saturation of the motor", "At high current the force grows less than the current.",
        "Keep accelerations below where it bends, or enter the motor's force curve in the drive."},
    Row{"backlash", "Lost motion (backlash)", "The measured position stands while the motor moves on at a reversal.",
        "Check couplings, nut preload and the scale's mounting; a backlash compensation hides it at low speed only."},
    Row{"structural_resonance", "Elastic mode", "Something between motor and encoder swings: coupling, screw, mount.",
        "Set a notch at its frequency or lower the velocity gain; make jerk times multiples of its period; stiffen the "
        "joint, or measure nearer to the motor."},
    Row{"encoder_subdivision_error", "Subdivision error of the encoder",
        "The measured position swings about the true one with each signal period of the encoder.",
        "Clean and adjust the reading head; correct offset, amplitude and phase of its signals in the interpolator."},
    Row{"time_skew", "Time skew of the record", "Current and position were not recorded at the same instant.",
        "Correct the recorder's delay before anything else is identified from its logs; where the delay is in the loop "
        "itself, it costs phase margin."},
    Row{"cross_axis_coupling", "Coupling with the other axis", "The other axis' acceleration pushes this one.",
        "Check squareness and where the centre of mass of what is mounted lies; feed the other axis' set acceleration "
        "forward."},
    Row{"periodic_disturbance", "Disturbance at a fixed frequency",
        "A force swings at a frequency that does not depend on the motion.",
        "Switch pumps, fans and the spindle off one after another at standstill and watch the line go. Balance or "
        "decouple what it is."},
    Row{"controller_gain_mismatch", "Gains of the drive",
        "The drive commands something else than the file's controller would for the same set-points and positions.",
        "Read the gains out of the drive and put them into the machine file; look for units (RMS or peak amperes, 1/s "
        "or m/min/mm) before a new tuning."},
};

}  // namespace

CauseText cause_text(const std::string& effect) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& each) { return each.effect == effect; });
  if (row != rows.end()) return {std::string(row->title), std::string(row->meaning), std::string(row->advice)};
  std::string title = effect;
  std::replace(title.begin(), title.end(), '_', ' ');
  return {title, "", "Simulate with the extended machine file; see the effect's page."};
}

}  // namespace stiction::host
