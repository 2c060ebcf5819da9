// The keys of a machine file, each described once: what the reader accepts, what its messages say and what the
// reference page shows come from these tables. The tables of the friction models stand with the models.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>

#include "firmware/machine/file/compensation_parameters.hpp"
#include "firmware/machine/file/feed_drive_parameters.hpp"
#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

inline constexpr std::string_view machine_schema = "stiction.machine/1";

// Rows [[axis.NAME.effect]]; the keys of each effect stand with it (sim/effects).
inline constexpr std::string_view effect_key = "effect";
inline constexpr std::string_view effect_name_key = "name";

// The experiments a file may hold overrides for, [experiment.NAME].
inline constexpr std::array<std::string_view, 11> experiment_names{
    "circle",       "constant-velocity",  "impact", "l-shape", "presliding", "friction-lag", "break-away", "stick-slip",
    "feed-cutting", "frequency-response", "replay"};

template <>
struct Table<Timing> : EmptyTable<Timing> {
  static constexpr std::string_view text = "periods of the control loops";
  static constexpr std::array<Parameter<Timing>, 4> parameters{{
      {"fast_period",
       "s",
       {33e-6, 0.1},
       &Timing::fast_period,
       62.5e-6,
       "current and velocity controllers, feedforwards"},
      {"slow_period", "s", {1e-6, 1.0}, &Timing::slow_period, 1e-3, "position controller, a multiple of fast_period"},
      {"set_point_delay", "s", not_negative(0.1), &Timing::set_point_delay, 0.0,
       "delay of every axis behind its set-points while friction compensation acts, which looks ahead by it; a "
       "multiple of fast_period, at most 15 of them"},
      {"plant_steps",
       "1",
       {4.0, 65536.0},
       &Timing::plant_steps,
       4.0,
       "steps of the simulated plant in a fast period; more cost time alike"},
  }};
};

inline constexpr std::array<Choice<MotorModel>, 3> motor_models{{
    {"synchronous", MotorModel::synchronous, "three phases"},
    {"dc", MotorModel::dc, "equivalent with one winding"},
    {"force", MotorModel::force, "ideal force source driven by voltage, or by current"},
}};

template <>
struct Table<MotorParameters> : EmptyTable<MotorParameters> {
  static constexpr std::string_view text = "motor";
  static constexpr std::tuple choices{
      ChoiceParameter<MotorParameters, MotorModel>{"model", &MotorParameters::model, motor_models, {}, "motor model"}};
  static constexpr std::array<Parameter<MotorParameters>, 10> parameters{{
      {"phase_resistance", "Ohm", positive(), &MotorParameters::phase_resistance, 0.0, "resistance R of one winding"},
      {"phase_inductance", "H", positive(), &MotorParameters::phase_inductance, 0.0, "inductance L of one winding"},
      {"mutual_inductance", "H", not_negative(), &MotorParameters::mutual_inductance, 0.0,
       "mutual inductance M of two windings"},
      {"emf_constant", "V s/m", positive(), &MotorParameters::emf_constant, 0.0, "induced voltage K_E of one winding"},
      {"phase_force_constant", "N/A", positive(), &MotorParameters::phase_force_constant, 0.0,
       "force constant K_F of one winding, by default 2/3 of force_constant"},
      {"force_constant",
       "N/A",
       positive(),
       &MotorParameters::force_constant,
       {},
       "force constant of the whole motor, amplitude amperes; the unit says what drives a force source",
       "N/V"},
      {"pole_pair_pitch", "m", positive(), &MotorParameters::pole_pair_pitch, 0.0, "pole-pair pitch tau_p"},
      {"count", "1", {1.0, 64.0}, &MotorParameters::count, 1.0, "motors in parallel on one servo module"},
      {"thermal_resistance", "K/W", not_negative(), &MotorParameters::thermal_resistance, 0.0,
       "rise of the windings' temperature by their losses; 0: they stay cold"},
      {"thermal_time_constant", "s", positive(), &MotorParameters::thermal_time_constant, 600.0,
       "time constant of that rise"},
  }};
};

template <>
struct Table<InverterParameters> : EmptyTable<InverterParameters> {
  static constexpr std::string_view text = "inverter";
  static constexpr std::array<Parameter<InverterParameters>, 8> parameters{{
      {"dead_time",
       "s",
       not_negative(0.1),
       &InverterParameters::dead_time,
       {},
       "delay from the controller's output to the motor's voltage, a multiple of fast_period/4"},
      {"voltage_limit", "V", positive(), &InverterParameters::voltage_limit, {}, "largest voltage"},
      {"current_limit", "A", positive(), &InverterParameters::current_limit, std::numeric_limits<double>::infinity(),
       "largest current per motor"},
      {"dc_link",
       "V",
       positive(),
       &InverterParameters::dc_link,
       {},
       "voltage of the DC link as its rectifier makes it; left out: voltage_limit"},
      {"dc_link_capacitance", "F", not_negative(), &InverterParameters::dc_link_capacitance, 0.0,
       "capacitor that a braking motor charges; 0: the DC link stays as it is"},
      {"loss_voltage", "V", not_negative(), &InverterParameters::loss_voltage, 0.0,
       "losses of the power stage per ampere in a phase"},
      {"thermal_resistance", "K/W", not_negative(), &InverterParameters::thermal_resistance, 0.0,
       "rise of the power stage's temperature by its losses; 0: it stays cold"},
      {"thermal_time_constant", "s", positive(), &InverterParameters::thermal_time_constant, 60.0,
       "time constant of that rise"},
  }};
};

template <>
struct Table<EncoderMountParameters> : EmptyTable<EncoderMountParameters> {
  static constexpr std::string_view text = "elastic mount of the encoder's rider";
  // Below 1 Hz the weights of a step lose more than half of their digits, far below they overflow; above 1 MHz the
  // rider is rigid at any step, and a file leaves it out.
  static constexpr Range natural_frequencies{1.0, 1e6};
  static constexpr std::array<Parameter<EncoderMountParameters>, 3> parameters{{
      {"mass", "kg", positive(), &EncoderMountParameters::mass, {}, "mass of the rider"},
      {"natural_frequency",
       "Hz",
       natural_frequencies,
       &EncoderMountParameters::natural_frequency,
       {},
       "natural frequency of the rider"},
      {"damping_ratio",
       "1",
       not_negative(0.999),
       &EncoderMountParameters::damping_ratio,
       {},
       "damping ratio of the rider"},
  }};
};

inline constexpr std::array<Choice<VelocitySource>, 3> velocity_sources{{
    {"ideal", VelocitySource::ideal, "continuous derivative, as the published simulation had it"},
    {"estimated", VelocitySource::estimated, "estimate of a drive from time-stamped positions"},
    {"mean-difference", VelocitySource::mean_difference, "difference of two-sample means"},
}};

inline constexpr std::array<Choice<EncoderPlace>, 2> encoder_places{{
    {"load", EncoderPlace::load, "the axis itself"},
    {"motor", EncoderPlace::motor, "the motor's shaft"},
}};

inline constexpr Range encoder_delays = not_negative(0.1);

template <>
struct Table<FurtherEncoderParameters> : EmptyTable<FurtherEncoderParameters> {
  static constexpr std::string_view text = "encoder in addition to that of the position controller";
  static constexpr std::array<Parameter<FurtherEncoderParameters>, 4> parameters{{
      {"increment", "m", not_negative(), &FurtherEncoderParameters::increment, 0.0,
       "increment after interpolation; 0: continuous"},
      {"counts",
       "1",
       positive(),
       &FurtherEncoderParameters::counts,
       {},
       "edges in a turn of its shaft, after quadrature; in place of increment"},
      {"noise", "m", not_negative(), &FurtherEncoderParameters::noise, 0.0, "noise of the position, rms"},
      {"delay", "s", encoder_delays, &FurtherEncoderParameters::delay, 0.0, "age of the position that it shows"},
  }};
  static constexpr std::tuple choices{ChoiceParameter<FurtherEncoderParameters, EncoderPlace>{
      "on", &FurtherEncoderParameters::on, encoder_places, EncoderPlace::load, "what it sits on"}};
};

template <>
struct Table<EncoderParameters> : EmptyTable<EncoderParameters> {
  static constexpr std::string_view text = "position encoder";
  static constexpr std::array<Parameter<EncoderParameters>, 5> parameters{{
      {"increment", "m", not_negative(), &EncoderParameters::increment, 0.0,
       "increment after interpolation; 0: continuous"},
      {"counts",
       "1",
       positive(),
       &EncoderParameters::counts,
       {},
       "edges in a turn of its shaft, after quadrature; in place of increment"},
      {"noise", "m", not_negative(), &EncoderParameters::noise, 0.0, "noise of the position, rms"},
      {"delay", "s", encoder_delays, &EncoderParameters::delay, 0.0, "age of the position that it shows"},
      {"commutation_offset", "rad", any_value(), &EncoderParameters::commutation_offset, 0.0,
       "true electrical angle of a three-phase motor where the encoder shows zero; the drive never reads it"},
  }};
  static constexpr std::tuple choices{
      ChoiceParameter<EncoderParameters, VelocitySource>{"velocity", &EncoderParameters::velocity, velocity_sources,
                                                         VelocitySource::estimated, "source of the measured velocity"},
      ChoiceParameter<EncoderParameters, EncoderPlace>{"on", &EncoderParameters::on, encoder_places, EncoderPlace::load,
                                                       "what it sits on"}};
  static constexpr std::tuple subtables{Subtable<EncoderParameters, std::optional<EncoderMountParameters>>{
      "mount", &EncoderParameters::mount, Presence::optional}};
};

template <>
struct Table<PositionControllerParameters> : EmptyTable<PositionControllerParameters> {
  static constexpr std::string_view text = "proportional position controller";
  static constexpr std::array<Parameter<PositionControllerParameters>, 2> parameters{{
      {"gain", "1/s", positive(), &PositionControllerParameters::gain, {}, "position gain K_v"},
      {"increment", "m", not_negative(), &PositionControllerParameters::increment, 0.0,
       "increment of the position error's quantizer; 0: none"},
  }};
};

template <>
struct Table<VelocityControllerParameters> : EmptyTable<VelocityControllerParameters> {
  static constexpr std::string_view text = "velocity controller";
  static constexpr std::array<Parameter<VelocityControllerParameters>, 2> parameters{{
      {"gain", "A s/m", positive(), &VelocityControllerParameters::gain, {}, "velocity gain k_pv", "V s/m"},
      {"integral_time",
       "s",
       positive(),
       &VelocityControllerParameters::integral_time,
       {},
       "integral time T_Nv; left out: proportional only"},
  }};
};

template <>
struct Table<CurrentControllerParameters> : EmptyTable<CurrentControllerParameters> {
  static constexpr std::string_view text = "current controller; a force motor has none";
  static constexpr std::array<Parameter<CurrentControllerParameters>, 2> parameters{{
      {"gain", "V/A", positive(), &CurrentControllerParameters::gain, {}, "current gain k_pi"},
      {"integral_time",
       "s",
       positive(),
       &CurrentControllerParameters::integral_time,
       {},
       "integral time T_Ni; left out: proportional only"},
  }};
};

template <>
struct Table<NotchParameters> : EmptyTable<NotchParameters> {
  static constexpr std::string_view text = "notch behind the velocity controller; left out: none";
  static constexpr std::array<Parameter<NotchParameters>, 3> parameters{{
      {"frequency",
       "Hz",
       positive(),
       &NotchParameters::frequency,
       {},
       "centre frequency, below half the fast loop's rate"},
      {"numerator_damping",
       "1",
       not_negative(10.0),
       &NotchParameters::numerator_damping,
       {},
       "depth zeta_F1, 0 is deepest"},
      {"denominator_damping", "1", positive(10.0), &NotchParameters::denominator_damping, {}, "width zeta_F2"},
  }};
};

template <>
struct Table<FeedforwardParameters> : EmptyTable<FeedforwardParameters> {
  static constexpr std::string_view text = "feedforward of the set-points";
  static constexpr std::array<Parameter<FeedforwardParameters>, 2> parameters{{
      {"velocity", "1", not_negative(10.0), &FeedforwardParameters::velocity, 0.0,
       "velocity feedforward K_wv; 1: full"},
      {"current", "1", not_negative(10.0), &FeedforwardParameters::current, 0.0, "current feedforward K_wi; 1: full"},
  }};
};

template <>
struct Table<SupervisionParameters> : EmptyTable<SupervisionParameters> {
  static constexpr std::string_view text = "limits whose violation is a fault";
  static constexpr std::array<Parameter<SupervisionParameters>, 3> parameters{{
      {"following_error",
       "m",
       positive(),
       &SupervisionParameters::following_error,
       {},
       "following error; left out: 2 mm"},
      {"over_current",
       "A",
       positive(),
       &SupervisionParameters::over_current,
       {},
       "current of the whole axis; left out: 1.2 times the current limit"},
      {"over_speed",
       "m/s",
       positive(),
       &SupervisionParameters::over_speed,
       {},
       "speed; left out: 1.2 times max_velocity"},
  }};
};

template <>
struct Table<FrictionParameters> : EmptyTable<FrictionParameters> {
  static constexpr std::string_view text = "friction on the carriage: one table a model";
  static constexpr std::array<TextParameter<FrictionParameters>, 1> texts{
      {{"use", &FrictionParameters::use, "the active model, unless a command names a different one"}}};
};

inline constexpr std::array<Choice<AxisKind>, 2> axis_kinds{{
    {"linear", AxisKind::linear, "lengths and forces"},
    {"rotary", AxisKind::rotary, "angles and torques"},
}};

template <>
struct Table<MotorFriction> : EmptyTable<MotorFriction> {
  static constexpr std::string_view text =
      "friction on a rotary motor, at its shaft: one table a model, with the keys of axis.NAME.friction; a stiff axis "
      "has coulomb_viscous or classical on both";
  static constexpr std::array<TextParameter<MotorFriction>, 1> texts{
      {{"use", &MotorFriction::use, "the active model"}}};
};

template <>
struct Table<GravityParameters> : EmptyTable<GravityParameters> {
  static constexpr std::string_view text = "weight, and what balances it; left out: none";
  static constexpr std::array<Parameter<GravityParameters>, 4> parameters{{
      {"force", "N", not_negative(), &GravityParameters::force, 0.0,
       "weight of the load, towards -x; of a rotary axis its moment about the rest below"},
      {"zero", "m", any_value(), &GravityParameters::zero, 0.0, "angle of the rest below, of a rotary axis"},
      {"counterweight",
       "N",
       not_negative(),
       &GravityParameters::counterweight,
       {},
       "force against the weight; left out: that of counterweight_mass, or none"},
      {"counterweight_mass",
       "kg",
       positive(),
       &GravityParameters::counterweight_mass,
       {},
       "mass of the counterweight where it moves along, of a linear axis"},
  }};
};

template <>
struct Table<BrakeParameters> : EmptyTable<BrakeParameters> {
  static constexpr std::string_view text = "brake that holds the axis without power; left out: none";
  static constexpr std::array<Parameter<BrakeParameters>, 2> parameters{{
      {"stiffness", "N/m", positive(), &BrakeParameters::stiffness, 1e8,
       "stiffness with which it holds until it slips"},
      {"holding_force", "N", positive(), &BrakeParameters::holding_force, {}, "force that it holds before it slips"},
  }};
};

inline constexpr std::array<Choice<ControlStructure>, 5> control_structures{{
    {"cascade", ControlStructure::cascade, "the firmware's: position, velocity and current controller"},
    {"p-voltage", ControlStructure::p_voltage, "voltage proportional to the position error"},
    {"pd", ControlStructure::pd, "position error and its derivative"},
    {"pid", ControlStructure::pid, "position error, its integral and its derivative"},
    {"unknown", ControlStructure::unknown, "nothing is known: what needs the controller says so"},
}};

template <>
struct Table<ControllerParameters> : EmptyTable<ControllerParameters> {
  static constexpr std::string_view text =
      "a controller other than the firmware's cascade, in the host's simulation; left out: the cascade";
  static constexpr std::tuple choices{ChoiceParameter<ControllerParameters, ControlStructure>{
      "structure", &ControllerParameters::structure, control_structures, ControlStructure::cascade,
      "structure of the controller"}};
  static constexpr std::array<Parameter<ControllerParameters>, 5> parameters{{
      {"gain", "A/m", positive(), &ControllerParameters::gain, 0.0,
       "output per position error; the unit says whether it is a current or a voltage", "V/m"},
      {"derivative", "A s/m", not_negative(), &ControllerParameters::derivative, 0.0, "output per velocity error",
       "V s/m"},
      {"integral_time", "s", positive(), &ControllerParameters::integral_time, {}, "integral time"},
      {"period",
       "s",
       positive(1.0),
       &ControllerParameters::period,
       {},
       "a multiple of fast_period; left out: fast_period"},
      {"supply", "V", positive(), &ControllerParameters::supply, {}, "largest voltage of the output"},
  }};
};

template <>
struct Table<TransmissionErrorParameters> : EmptyTable<TransmissionErrorParameters> {
  static constexpr std::string_view text = "error of the transmission, periodic in the turns of a shaft";
  static constexpr std::array<Parameter<TransmissionErrorParameters>, 3> parameters{{
      {"amplitude", "m", not_negative(), &TransmissionErrorParameters::amplitude, 0.0,
       "by how much the load is ahead, at most"},
      {"order", "1", positive(), &TransmissionErrorParameters::order, 1.0, "waves in a turn of the shaft"},
      {"phase", "rad", any_value(), &TransmissionErrorParameters::phase, 0.0, "of the wave at the position 0"},
  }};
};

template <>
struct Table<TransmissionParameters> : EmptyTable<TransmissionParameters> {
  static constexpr std::string_view text =
      "transmission from a rotary motor, to which the mass of the axis is the load alone; left out: direct";
  static constexpr std::array<Parameter<TransmissionParameters>, 12> parameters{{
      {"ratio", "1", positive(), &TransmissionParameters::ratio, 1.0,
       "motor turns per turn of screw, pulley or rotary axis; a number or a fraction such as \"355/113\""},
      {"lead", "m", positive(), &TransmissionParameters::lead, {}, "way of a turn of the screw"},
      {"pulley_circumference",
       "m",
       positive(),
       &TransmissionParameters::pulley_circumference,
       {},
       "way of a turn of the pulley"},
      {"motor_inertia", "kg m^2", not_negative(), &TransmissionParameters::motor_inertia, 0.0,
       "inertia at the motor's shaft"},
      {"screw_inertia", "kg m^2", not_negative(), &TransmissionParameters::screw_inertia, 0.0,
       "inertia at the screw or pulley"},
      {"stiffness",
       "N/m",
       positive(),
       &TransmissionParameters::stiffness,
       {},
       "stiffness of motor against load, at the load; left out: stiff"},
      {"damping",
       "N s/m",
       not_negative(),
       &TransmissionParameters::damping,
       {},
       "damping of motor against load; with stiffness"},
      {"damping_ratio",
       "1",
       not_negative(1.0),
       &TransmissionParameters::damping_ratio,
       {},
       "damping ratio of the mode of both masses, free; in place of damping"},
      {"backlash", "m", not_negative(), &TransmissionParameters::backlash, 0.0,
       "play at the load, from contact to contact; with stiffness"},
      {"stiffness_loss",
       "1",
       {0.0, 0.9},
       &TransmissionParameters::stiffness_loss,
       0.0,
       "share of the stiffness that a warm transmission has lost; with stiffness and warming_time"},
      {"warming_time",
       "s",
       positive(),
       &TransmissionParameters::warming_time,
       {},
       "time constant of the warming, from the start on"},
      {"gear_ratio",
       "1",
       positive(),
       &TransmissionParameters::gear_ratio,
       {},
       "turns of a wheel inside the gear per turn of screw, pulley or rotary axis; with gear_error"},
  }};
  static constexpr std::tuple subtables{Subtable<TransmissionParameters, std::optional<TransmissionErrorParameters>>{
                                            "motor_error", &TransmissionParameters::motor_error, Presence::optional},
                                        Subtable<TransmissionParameters, std::optional<TransmissionErrorParameters>>{
                                            "gear_error", &TransmissionParameters::gear_error, Presence::optional},
                                        Subtable<TransmissionParameters, std::optional<TransmissionErrorParameters>>{
                                            "output_error", &TransmissionParameters::output_error, Presence::optional}};
};

template <>
struct Table<AxisModel> : EmptyTable<AxisModel> {
  static constexpr std::string_view text = "one axis";
  static constexpr std::tuple choices{
      ChoiceParameter<AxisModel, AxisKind>{"kind", &AxisModel::kind, axis_kinds, AxisKind::linear, "kind of the axis"}};
  static constexpr std::array<Parameter<AxisModel>, 5> parameters{{
      {"mass", "kg", positive(), &AxisModel::mass, {}, "moving mass"},
      {"travel", "m", positive(), &AxisModel::travel, 0.0, "travel from end to end"},
      {"modulo",
       "m",
       positive(),
       &AxisModel::modulo,
       {},
       "way after which an endless axis is where it was; in place of travel"},
      {"max_velocity", "m/s", positive(), &AxisModel::max_velocity, {}, "largest velocity"},
      {"max_acceleration", "m/s^2", positive(), &AxisModel::max_acceleration, {}, "largest acceleration"},
  }};
  static constexpr std::tuple subtables{
      Subtable<AxisModel, std::optional<TransmissionParameters>>{"transmission", &AxisModel::transmission,
                                                                 Presence::optional},
      Subtable<AxisModel, MotorParameters>{"motor", &AxisModel::motor, Presence::required},
      Subtable<AxisModel, InverterParameters>{"inverter", &AxisModel::inverter, Presence::by_motor_model},
      Subtable<AxisModel, EncoderParameters>{"encoder", &AxisModel::encoder, Presence::required},
      Subtable<AxisModel, std::optional<FurtherEncoderParameters>>{"velocity_encoder", &AxisModel::velocity_encoder,
                                                                   Presence::optional},
      Subtable<AxisModel, std::optional<FurtherEncoderParameters>>{"second_encoder", &AxisModel::second_encoder,
                                                                   Presence::optional},
      Subtable<AxisModel, std::optional<GravityParameters>>{"gravity", &AxisModel::gravity, Presence::optional},
      Subtable<AxisModel, std::optional<BrakeParameters>>{"brake", &AxisModel::brake, Presence::optional},
      Subtable<AxisModel, std::optional<ControllerParameters>>{"controller", &AxisModel::controller,
                                                               Presence::optional},
      Subtable<AxisModel, PositionControllerParameters>{"position_controller", &AxisModel::position_controller,
                                                        Presence::by_structure},
      Subtable<AxisModel, VelocityControllerParameters>{"velocity_controller", &AxisModel::velocity_controller,
                                                        Presence::by_structure},
      Subtable<AxisModel, std::optional<CurrentControllerParameters>>{
          "current_controller", &AxisModel::current_controller, Presence::by_motor_model},
      Subtable<AxisModel, std::optional<NotchParameters>>{"notch", &AxisModel::notch, Presence::optional},
      Subtable<AxisModel, FeedforwardParameters>{"feedforward", &AxisModel::feedforward, Presence::optional},
      Subtable<AxisModel, SupervisionParameters>{"supervision", &AxisModel::supervision, Presence::optional},
      Subtable<AxisModel, FrictionParameters>{"friction", &AxisModel::friction, Presence::required},
      Subtable<AxisModel, std::optional<MotorFriction>>{"motor_friction", &AxisModel::motor_friction,
                                                        Presence::optional},
      Subtable<AxisModel, std::optional<FrictionCompensationParameters>>{
          "friction_compensation", &AxisModel::friction_compensation, Presence::optional},
  };
};

// Beyond the tables above: keys from the axis on of which exactly one must be there, where their table is.
struct Alternatives {
  std::string_view first, second;
};
inline constexpr std::array alternatives{
    Alternatives{"travel", "modulo"},
    Alternatives{"encoder.increment", "encoder.counts"},
    Alternatives{"velocity_encoder.increment", "velocity_encoder.counts"},
    Alternatives{"second_encoder.increment", "second_encoder.counts"},
};

// What each structure of the controller makes necessary (keys and tables from the axis on) and what it excludes.
struct StructureRule {
  ControlStructure structure;
  std::span<const std::string_view> needs;
  std::span<const std::string_view> excludes;
};
inline constexpr std::array<std::string_view, 2> needs_of_cascade{"position_controller", "velocity_controller"};
inline constexpr std::array<std::string_view, 5> excluded_by_cascade{
    "controller.gain", "controller.derivative", "controller.integral_time", "controller.period", "controller.supply"};
inline constexpr std::array<std::string_view, 2> needs_of_p_voltage{"controller.gain", "controller.supply"};
inline constexpr std::array<std::string_view, 8> excluded_by_p_voltage{
    "controller.derivative", "controller.integral_time", "position_controller",
    "velocity_controller",   "current_controller",       "notch",
    "feedforward",           "friction_compensation"};
inline constexpr std::array<std::string_view, 2> needs_of_pd{"controller.gain", "controller.derivative"};
inline constexpr std::array<std::string_view, 6> excluded_by_pd{
    "controller.integral_time", "position_controller", "velocity_controller", "notch", "feedforward",
    "friction_compensation"};
inline constexpr std::array<std::string_view, 3> needs_of_pid{"controller.gain", "controller.derivative",
                                                              "controller.integral_time"};
inline constexpr std::array<std::string_view, 5> excluded_by_pid{"position_controller", "velocity_controller", "notch",
                                                                 "feedforward", "friction_compensation"};
inline constexpr std::array<std::string_view, 9> excluded_by_unknown{"controller.gain",
                                                                     "controller.derivative",
                                                                     "controller.integral_time",
                                                                     "controller.period",
                                                                     "position_controller",
                                                                     "velocity_controller",
                                                                     "notch",
                                                                     "feedforward",
                                                                     "friction_compensation"};
inline constexpr std::array structure_rules{
    StructureRule{ControlStructure::cascade, needs_of_cascade, excluded_by_cascade},
    StructureRule{ControlStructure::p_voltage, needs_of_p_voltage, excluded_by_p_voltage},
    StructureRule{ControlStructure::pd, needs_of_pd, excluded_by_pd},
    StructureRule{ControlStructure::pid, needs_of_pid, excluded_by_pid},
    StructureRule{ControlStructure::unknown, {}, excluded_by_unknown},
};

// What each motor model makes necessary (keys from the axis on) and what it excludes.
struct MotorRule {
  MotorModel model;
  std::span<const std::string_view> needs;
  std::span<const std::string_view> excludes;
};
inline constexpr std::array<std::string_view, 8> needs_of_synchronous{
    "inverter",           "motor.phase_resistance", "motor.phase_inductance", "motor.mutual_inductance",
    "motor.emf_constant", "motor.pole_pair_pitch",  "inverter.current_limit", "current_controller"};
inline constexpr std::array<std::string_view, 6> needs_of_dc{
    "inverter",           "motor.phase_resistance", "motor.phase_inductance",
    "motor.emf_constant", "inverter.current_limit", "current_controller"};
inline constexpr std::array<std::string_view, 1> excluded_by_force{"current_controller"};
inline constexpr std::array<MotorRule, 3> motor_rules{{
    {MotorModel::synchronous, needs_of_synchronous, {}},
    {MotorModel::dc, needs_of_dc, {}},
    {MotorModel::force, {}, excluded_by_force},
}};

inline constexpr std::array<Choice<bool>, 2> reference_sources{{
    {"measured", true, "a measurement"},
    {"published simulation", false, "a simulation by others, with its friction model"},
}};

template <>
struct Table<CircleReference> : EmptyTable<CircleReference> {
  static constexpr std::string_view text = "a published or measured circle that reports compare with the simulation";
  static constexpr std::array<TextParameter<CircleReference>, 2> texts{{
      {"axis", &CircleReference::axis, "name of the axis"},
      {"friction", &CircleReference::friction, "friction model of a published simulation"},
  }};
  static constexpr std::tuple choices{ChoiceParameter<CircleReference, bool>{
      "source", &CircleReference::measured, reference_sources, {}, "where the row comes from"}};
  static constexpr std::array<Parameter<CircleReference>, 3> parameters{{
      {"feed", "m/s", positive(), &CircleReference::feed, {}, "feed along the path"},
      {"error", "m", not_negative(), &CircleReference::error, {}, "peak quadrant error"},
      {"current", "A", not_negative(), &CircleReference::current, {}, "peak current"},
  }};
};

template <>
struct Table<SteadyFrictionReference> : EmptyTable<SteadyFrictionReference> {
  static constexpr std::string_view text = "measured current of steady motion, from which friction is identified";
  static constexpr std::array<TextParameter<SteadyFrictionReference>, 1> texts{{
      {"axis", &SteadyFrictionReference::axis, "name of the axis"},
  }};
  static constexpr std::array<Parameter<SteadyFrictionReference>, 2> parameters{{
      {"velocity", "m/s", positive(), &SteadyFrictionReference::velocity, {}, "steady velocity"},
      {"current", "A", not_negative(), &SteadyFrictionReference::current, {}, "current of the whole axis"},
  }};
};

inline constexpr std::array<Choice<bool>, 2> load_directions{{
    {"same", true, "loaded in the direction of the motion before the rest"},
    {"opposite", false, "loaded against it"},
}};

template <>
struct Table<PreslidingReference> : EmptyTable<PreslidingReference> {
  static constexpr std::string_view text = "measured displacement under a force too small for sliding, after coasting";
  static constexpr std::array<TextParameter<PreslidingReference>, 1> texts{{
      {"axis", &PreslidingReference::axis, "name of the axis, or of the one whose guides the test rig had"},
  }};
  static constexpr std::tuple choices{ChoiceParameter<PreslidingReference, bool>{
      "direction", &PreslidingReference::same_direction, load_directions, {}, "direction of the force"}};
  static constexpr std::array<Parameter<PreslidingReference>, 2> parameters{{
      {"force", "N", positive(), &PreslidingReference::force, {}, "force on the carriage"},
      {"displacement", "m", not_negative(), &PreslidingReference::displacement, {}, "displacement under it"},
  }};
};

template <>
struct Table<Machine> : EmptyTable<Machine> {
  static constexpr std::string_view text = "the machine";
  static constexpr std::array<TextParameter<Machine>, 1> texts{{{"name", &Machine::name, "name shown in reports"}}};
  static constexpr std::tuple subtables{
      Subtable<Machine, Timing>{"timing", &Machine::timing, Presence::optional},
      Subtable<Machine, std::optional<FeedDrive>>{"feed_drive", &Machine::feed_drive, Presence::optional}};
};

}  // namespace stiction::machine
