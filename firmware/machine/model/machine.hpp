// A machine as its file describes it, in SI units, all its axes as linear ones (coordinate.hpp): what the simulated
// plant is built from and what the drive's configuration is computed from. Format: README, "Machine file"; the reader
// is machine_file.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/coordinate.hpp"
#include "firmware/machine/model/effect.hpp"
#include "firmware/machine/model/feed_drive.hpp"
#include "firmware/machine/model/fraction.hpp"
#include "firmware/machine/model/value_table.hpp"
#include "stiction/control/compensation_kind.hpp"

namespace stiction::machine {

enum class MotorModel { synchronous, dc, force };

// Where the velocity controller's feedback comes from.
enum class VelocitySource {
  ideal,            // continuous derivative of the encoder's position, as the published simulation had it
  estimated,        // from time-stamped positions, what a drive can do
  mean_difference,  // difference of two-sample means (the EMPS controller)
};

struct Timing {
  double fast_period = 62.5e-6;  // s: current and velocity controllers, feedforwards
  double slow_period = 1e-3;     // s: position controller
  double set_point_delay = 0.0;  // s: by which the axes follow their set-points late, for compensation to look ahead
  int plant_steps = 4;           // of the simulated plant in a fast period
};

struct MotorParameters {
  MotorModel model = MotorModel::dc;
  bool amperes = false;                  // of a force source: its command is a current, not a voltage
  double phase_resistance = 0.0;         // Ohm
  double phase_inductance = 0.0;         // H
  double mutual_inductance = 0.0;        // H
  double emf_constant = 0.0;             // V s/m, one winding
  double phase_force_constant = 0.0;     // N/A, one winding
  double force_constant = 0.0;           // N/A of the whole motor, amplitude amperes; N/V for a force source of volts
  double pole_pair_pitch = 0.0;          // m
  int count = 1;                         // motors in parallel on one servo module
  double thermal_resistance = 0.0;       // K/W, of the windings against the air
  double thermal_time_constant = 600.0;  // s

  bool driven_by_volts() const { return model == MotorModel::force && !amperes; }
};

// What stands for no limit where the file gives none (V, A): finite, since the drive's numbers are.
inline constexpr double unlimited = 1e15;

struct InverterParameters {
  double dead_time = 0.0;               // s
  double voltage_limit = 0.0;           // V
  double current_limit = 0.0;           // A per motor
  std::optional<double> dc_link{};      // V, as the rectifier makes it; none: the voltage limit
  double dc_link_capacitance = 0.0;     // F; 0: the DC link stays as it is
  double loss_voltage = 0.0;            // V, times the current's magnitude in each phase: the losses
  double thermal_resistance = 0.0;      // K/W, of the power stage against the air
  double thermal_time_constant = 60.0;  // s
};

struct EncoderMountParameters {
  double mass = 0.0;               // kg
  double natural_frequency = 0.0;  // Hz
  double damping_ratio = 0.0;
};

// What an encoder sits on; with a rigid transmission both move alike.
enum class EncoderPlace { load, motor };

// An encoder beside that of the position controller.
struct FurtherEncoderParameters {
  EncoderPlace on = EncoderPlace::load;
  std::optional<double> counts;  // as those below
  double increment = 0.0;        // m; 0: continuous
  double noise = 0.0;            // m rms
  double delay = 0.0;            // s, of what it shows
};

struct EncoderParameters {
  EncoderPlace on = EncoderPlace::load;
  std::optional<double> counts;  // in a turn of what it sits on; then they make the increment
  double increment = 0.0;        // m; 0: continuous
  double noise = 0.0;            // m rms
  double delay = 0.0;            // s, of what it shows
  VelocitySource velocity = VelocitySource::estimated;
  std::optional<EncoderMountParameters> mount;  // none: rigid
  // rad, electrical: the true angle of a three-phase motor where the encoder shows zero. Of the plant alone: the drive
  // has an offset that was stored or that it finds (drive_setup.hpp).
  double commutation_offset = 0.0;
  std::uint64_t noise_draw = 0;  // which of its noises; of the plant alone
};

struct PositionControllerParameters {
  double gain = 0.0;       // 1/s
  double increment = 0.0;  // m, of the position error's quantizer; 0: none
};

struct VelocityControllerParameters {
  double gain = 0.0;                    // A s/m; V s/m with a force motor
  std::optional<double> integral_time;  // s; none: proportional only
};

struct CurrentControllerParameters {
  double gain = 0.0;                    // V/A
  std::optional<double> integral_time;  // s
};

struct NotchParameters {
  double frequency = 0.0;  // Hz
  double numerator_damping = 0.0;
  double denominator_damping = 0.0;
};

struct FeedforwardParameters {
  double velocity = 0.0;  // K_wv, 1 = full
  double current = 0.0;   // K_wi, 1 = full
};

// What closes the loop in place of the cascade, in the host's simulation alone.
enum class ControlStructure {
  cascade,    // position, velocity and current controller: the firmware's
  p_voltage,  // voltage proportional to the position error
  pd,
  pid,
  unknown,  // that of a drive of which nothing is known
};

struct ControllerParameters {
  ControlStructure structure = ControlStructure::cascade;
  bool in_volts = false;                // its output is a voltage, not a current
  double gain = 0.0;                    // A/m, or V/m
  double derivative = 0.0;              // A s/m, or V s/m, of the velocity error
  std::optional<double> integral_time;  // s
  std::optional<double> period;         // s; none: the fast period
  std::optional<double> supply;         // V, the largest output; none: the inverter's limit
};

// Weight of the axis and what balances it. Of a rotary axis the forces turn with its angle.
struct GravityParameters {
  double force = 0.0;                        // N, towards -x; N m of a rotary axis, m g l
  double zero = 0.0;                         // m; the angle of rest below
  std::optional<double> counterweight;       // N, towards +x; against the moment of a rotary axis
  std::optional<double> counterweight_mass;  // kg, that moves along
};

// Limits whose violation is a fault (the motion stops), unlike the limits of inverter and axis, which only limit.
struct SupervisionParameters {
  std::optional<double> following_error;  // m; none: 2 mm
  std::optional<double> over_current;     // A of the whole axis; none: 1.2 times the current limit
  std::optional<double> over_speed;       // m/s; none: 1.2 times max_velocity
};

struct FrictionParameters {
  std::string use;                            // name of the model that acts
  std::map<std::string, KeyedValues> models;  // every subtable of the file, by name
};

// Speed pulse at reversals, its amplitude over the acceleration there.
struct PulseCompensationParameters {
  double amplitude = 0.0;        // m/s
  double final_amplitude = 0.0;  // m/s
  double rise_until = 0.0;       // m/s^2, a1
  double flat_until = 0.0;       // m/s^2, a2
  double fall_until = 0.0;       // m/s^2, a3
  double delay = 0.0;            // s, from the reversal of the newest set-point
  double duration = 0.0;         // s
};

// Current against friction from the set-points: presliding by distance, a sliding curve by speed.
struct FrictionFeedforwardParameters {
  double look_ahead = 0.0;                // s, by which the current comes before the set-point
  std::vector<double> distance;           // m after a reversal at which each element slips again
  std::vector<double> level;              // A of each element; their sum is the Coulomb level
  double contact_damping = 0.0;           // s
  std::vector<double> speed;              // m/s
  std::vector<double> forward, backward;  // A beyond the Coulomb level at these speeds, in +v and in -v
};

// How the drive learns from the errors of earlier laps.
struct QuadrantLearningParameters {
  double gain = 0.0;           // of what was missing, per lap
  double forgetting = 0.0;     // share per lap
  double smoothing = 0.0;      // share of each neighbour per lap
  double limit = 0.0;          // A
  double dead_zone = 0.0;      // m
  double filter = 0.0;         // s
  std::optional<double> lead;  // s; none: mass / (velocity gain * force constant) - filter
};

// What a drive has learned; of one axis of one machine.
struct LearnedTable {
  std::string machine, axis;              // names
  std::vector<double> forward, backward;  // A at the nodes over the way since a reversal
};

// What the drive does against friction; the plant knows nothing of it.
struct FrictionCompensationParameters {
  CompensationKind use = CompensationKind::off;
  std::optional<PulseCompensationParameters> pulse;
  std::optional<FrictionFeedforwardParameters> friction;
  std::optional<QuadrantLearningParameters> learning;
  std::optional<LearnedTable> learned;
};

// The brake that holds an axis without power, of the plant: what it bears before it slips, and how it yields until
// then.
struct BrakeParameters {
  double holding_force = 0.0;  // N, at the axis
  double stiffness = 0.0;      // N/m
};

// Friction on the motor, at its shaft.
struct MotorFriction : FrictionParameters {};

// By how much the load is ahead of what the ratio alone makes of a shaft's angle: amplitude sin(order angle + phase).
struct TransmissionErrorParameters {
  double amplitude = 0.0;  // m at the load
  double order = 1.0;      // waves in a turn of the shaft
  double phase = 0.0;      // rad, at the position 0
};

// Between a rotary motor and the axis. Inertias and ways of a turn are in the file's own units, whatever the axis is.
struct TransmissionParameters {
  double ratio = 1.0;                          // motor turns per turn of screw, pulley or rotary axis
  std::optional<Fraction> exact_ratio;         // the same, not rounded; none: more digits than are kept
  std::optional<double> lead;                  // m per turn of the screw
  std::optional<double> pulley_circumference;  // m per turn of the pulley
  double motor_inertia = 0.0;                  // kg m^2, at the motor's shaft
  double screw_inertia = 0.0;                  // kg m^2, at the screw or pulley
  std::optional<double> stiffness;             // N/m at the load, of motor against load; none: stiff
  std::optional<double> damping;               // N s/m of the same, from damping_ratio where that is given
  std::optional<double> damping_ratio;         // of the mode of both masses, free
  double backlash = 0.0;                       // m at the load, from contact to contact
  double stiffness_loss = 0.0;                 // share of the stiffness that is lost when it is warm
  std::optional<double> warming_time;          // s, time constant from the start on; none: it keeps its stiffness
  std::optional<double> gear_ratio;            // turns of a wheel in the gear per turn of screw, pulley or rotary axis
  // Periodic in the turns of the motor, of that wheel, and of screw, pulley or rotary axis.
  std::optional<TransmissionErrorParameters> motor_error, gear_error, output_error;
};

struct AxisModel {
  std::string name;
  AxisKind kind = AxisKind::linear;
  Coordinate coordinate{};                             // of the values below in the file
  Coordinate motor_coordinate{};                       // of the motor's
  double mass = 0.0;                                   // kg, of all that moves, reduced to the axis
  double load_mass = 0.0;                              // kg, without what is added to it: what the file gives
  double motor_mass = 0.0;                             // kg, of the motor and the screw: what their inertias add
  double travel = 0.0;                                 // m; of an endless axis its modulo
  std::optional<double> modulo;                        // m, after which an endless axis is where it was
  std::optional<Fraction> exact_modulo;                // the same, not rounded: turns of a rotary axis, else m
  std::optional<Fraction> modulo_counts;               // of the encoder in a modulo; none: no such fraction
  double max_velocity = 0.0;                           // m/s
  double max_acceleration = 0.0;                       // m/s^2
  std::optional<TransmissionParameters> transmission;  // none: the motor moves the axis directly
  MotorParameters motor;
  InverterParameters inverter;
  EncoderParameters encoder;
  std::optional<FurtherEncoderParameters> velocity_encoder;  // none: the one above
  std::optional<FurtherEncoderParameters> second_encoder;    // only measured
  std::optional<GravityParameters> gravity;
  std::optional<BrakeParameters> brake;
  std::optional<ControllerParameters> controller;  // none: the cascade
  PositionControllerParameters position_controller;
  VelocityControllerParameters velocity_controller;
  std::optional<CurrentControllerParameters> current_controller;  // none with a force motor
  std::optional<NotchParameters> notch;
  FeedforwardParameters feedforward;
  SupervisionParameters supervision;
  FrictionParameters friction;                  // of all that moves; behind an elastic shaft of the load alone
  std::optional<MotorFriction> motor_friction;  // of what the file gives; acts by itself in front of an elastic shaft
  std::optional<FrictionCompensationParameters> friction_compensation;
  std::vector<Effect> effects;  // of the plant alone: the drive's configuration knows nothing of them
  // Why the firmware's number formats hold this axis on no radius, a sentence; empty: they hold it, or it is linear.
  std::string beyond_formats;

  bool elastic() const { return transmission && transmission->stiffness.has_value(); }
  // Whether the firmware's cascade controls it.
  bool cascaded() const { return !controller || controller->structure == ControlStructure::cascade; }
  // Whether nobody knows how it is controlled: then it is not simulated.
  bool unknown_controller() const { return controller && controller->structure == ControlStructure::unknown; }
  // Whether its command, whatever makes it, is a voltage.
  bool commanded_in_volts() const { return cascaded() ? motor.driven_by_volts() : controller->in_volts; }
};

// A row of a published or measured circle that reports stand beside the simulation. SI units.
struct CircleReference {
  std::string axis;
  bool measured = false;                // false: published simulation
  std::optional<std::string> friction;  // the model of a published simulation
  double feed = 0.0;                    // m/s
  double error = 0.0;                   // m, peak quadrant error
  double current = 0.0;                 // A, peak
};

// Friction of steady motion, measured. SI units.
struct SteadyFrictionReference {
  std::string axis;
  double velocity = 0.0;  // m/s
  double current = 0.0;   // A; friction is force constant times current
};

// Presliding displacement, measured: the axis coasted to rest and was then loaded. SI units.
struct PreslidingReference {
  std::string axis;
  bool same_direction = false;  // loaded in the direction of the motion before
  double force = 0.0;           // N
  double displacement = 0.0;    // m
};

// A figure that an experiment is expected to show on this machine ([[expected]]).
struct ExpectedFigure {
  std::string experiment;
  std::optional<std::string> axis, friction;
  std::string figure;                     // as in the results, without model and unit
  std::string value, tolerance;           // "92 um", as written: the unit is the figure's
  std::string source;                     // document and place
  std::vector<std::string> overrides;     // KEY=VALUE that the figure is for
  std::map<std::string, double> options;  // of the experiment, that it is for: "jerk", in SI
  std::string settings;                   // both as a command line has them
  bool in_force = false;                  // the machine runs with just these overrides
  std::string place;                      // "m.toml:412: expected[3]", for messages
};

struct Machine {
  std::string name;  // as in the file
  std::string id;    // file name without extension
  Timing timing;
  std::vector<AxisModel> axes;          // in the order of the file; none only where there is a feed drive
  std::optional<FeedDrive> feed_drive;  // with screw and sliding carriage; nothing connects it with the axes
  std::vector<CircleReference> circle_references;
  std::vector<SteadyFrictionReference> steady_friction_references;
  std::vector<PreslidingReference> presliding_references;
  std::vector<ExpectedFigure> expected;

  // Whether the firmware's number formats hold every rotary axis on some radius.
  bool fits_formats() const {
    for (const AxisModel& axis : axes)
      if (!axis.beyond_formats.empty()) return false;
    return true;
  }
};

}  // namespace stiction::machine
