// What the tables of an axis need of one another: controllers, shafts, weights, encoders, endless axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/firmware/machine/machine_text.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::machine {
namespace {

using test::error_of;
using test::read_text;
using test::replaced;

// A belt axis: a motor of 6e-5 kg m^2 on a pulley of 150 mm, so that a radian of the motor is 150 mm/(2 pi).
const std::string belt = R"(schema = "stiction.machine/1"
name = "belt"
[axis.B]
mass = "6 kg"
travel = "1 m"
max_velocity = "1 m/s"
max_acceleration = "10 m/s^2"
[axis.B.transmission]
pulley_circumference = "150 mm"
motor_inertia = "6e-5 kg m^2"
[axis.B.motor]
model = "force"
torque_constant = "0.1 N m/A"
[axis.B.inverter]
dead_time = "0 us"
voltage_limit = "24 V"
current_limit = "20 A"
[axis.B.encoder]
on = "motor"
counts = 4096
[axis.B.friction]
use = "classical"
[axis.B.friction.classical]
coulomb = "10 N"
static_ratio = 1.5
viscous = "20 N s/m"
)";
const std::string cascade = R"([axis.B.position_controller]
gain = "10 1/s"
[axis.B.velocity_controller]
gain = "20 A s/m"
)";
const std::string pd = R"([axis.B.controller]
structure = "pd"
gain = "800 A/m"
derivative = "20 A s/m"
)";
constexpr double motor_way = 0.15 / (2.0 * std::numbers::pi);  // m per radian of the motor

std::string with_line(std::string text, const std::string& behind, const std::string& line) {
  return replaced(std::move(text), behind, behind + "\n" + line);
}

// The refusal of `text`, from its key on.
void expect_refused(const std::string& text, const std::string& key, const std::string& says) {
  const auto error = error_of(text);
  EXPECT_NE(error.find(key), std::string::npos) << error;
  EXPECT_NE(error.find(says), std::string::npos) << error;
}

TEST(AxisRules, AForceSourceIsDrivenByWhatItsConstantSays) {
  const auto amperes = read_text(belt + cascade).axes[0];
  EXPECT_TRUE(amperes.motor.amperes);
  EXPECT_FALSE(amperes.commanded_in_volts());
  EXPECT_EQ(amperes.inverter.voltage_limit, 20.0) << "the command is limited as the current is";
  EXPECT_NEAR(amperes.motor.force_constant, 0.1 / motor_way, 1e-9);
  const auto volts = read_text(replaced(replaced(belt + cascade, "N m/A", "N m/V"), "A s/m", "V s/m")).axes[0];
  EXPECT_TRUE(volts.commanded_in_volts());
  EXPECT_EQ(volts.inverter.voltage_limit, 24.0);
}

TEST(AxisRules, AForceSourceNeedsNoInverter) {
  const auto text = replaced(belt + pd, R"([axis.B.inverter]
dead_time = "0 us"
voltage_limit = "24 V"
current_limit = "20 A"
)",
                             "");
  EXPECT_EQ(read_text(text).axes[0].inverter.current_limit, unlimited);
}

TEST(AxisRules, ControllersSayInWhatTheyCommand) {
  const auto in_amperes = read_text(belt + pd).axes[0];
  EXPECT_FALSE(in_amperes.cascaded());
  EXPECT_FALSE(in_amperes.commanded_in_volts());
  EXPECT_EQ(in_amperes.controller->gain, 800.0);
  const auto in_volts = read_text(belt + replaced(replaced(pd, "A/m", "V/m"), "A s/m", "V s/m")).axes[0];
  EXPECT_TRUE(in_volts.commanded_in_volts());
  EXPECT_FALSE(read_text(belt + "[axis.B.controller]\nstructure = \"unknown\"\n").axes[0].cascaded());
}

TEST(AxisRules, StructuresNeedAndExclude) {
  expect_refused(belt, "axis.B.position_controller: found no such table",
                 "[axis.B.position_controller] (proportional position controller)");
  expect_refused(belt + replaced(pd, "derivative = \"20 A s/m\"\n", ""),
                 "axis.B.controller.derivative: found no such key", "with controller structure \"pd\" (line 28)");
  expect_refused(belt + pd + cascade, "axis.B.position_controller: found a table", "none with controller structure");
  expect_refused(belt + pd + "integral_time = \"1 s\"\n", "axis.B.controller.integral_time", "none with controller");
  expect_refused(belt + pd + "period = \"100 us\"\n", "axis.B.controller.period", "a multiple of fast_period");
  expect_refused(belt + "[axis.B.controller]\nstructure = \"pd\"\ngain = \"800 A\"\nderivative = \"20 A s/m\"\n",
                 "axis.B.controller.gain", "A/m");
}

TEST(AxisRules, AShaftHasItsStiffnessAndItsDamping) {
  const auto elastic = [](const std::string& lines) {
    return with_line(belt + pd, "pulley_circumference = \"150 mm\"", lines);
  };
  const auto axis = read_text(elastic("stiffness = \"0.4 N/um\"\ndamping_ratio = 0.1\nbacklash = \"20 um\"")).axes[0];
  const double motor = 6e-5 / (motor_way * motor_way), reduced = motor * 6.0 / (motor + 6.0);
  EXPECT_TRUE(axis.elastic());
  EXPECT_NEAR(axis.motor_mass, motor, 1e-12 * motor);
  EXPECT_NEAR(*axis.transmission->damping, 2.0 * 0.1 * std::sqrt(4e5 * reduced), 1e-9);
  EXPECT_EQ(axis.transmission->backlash, 20e-6);
  expect_refused(elastic("stiffness = \"0.4 N/um\""), "axis.B.transmission.damping",
                 "damping or damping_ratio, together with");
  expect_refused(elastic("stiffness = \"0.4 N/um\"\ndamping_ratio = 0.1\ndamping = \"40 N s/m\""),
                 "transmission.damping_ratio", "one of them");
  expect_refused(elastic("backlash = \"20 um\""), "axis.B.transmission.backlash", "none without stiffness");
}

TEST(AxisRules, AGearWarmsAndErrsBehindItsShaftAlone) {
  const auto gear = [](const std::string& lines) {
    return with_line(belt + pd, "pulley_circumference = \"150 mm\"", lines);
  };
  const std::string shaft = "stiffness = \"0.4 N/um\"\ndamping_ratio = 0.1\n";
  const auto axis = read_text(gear(shaft + "stiffness_loss = 0.15\nwarming_time = \"300 s\"\ngear_ratio = 5\n"
                                           "gear_error = { amplitude = \"3 um\", order = 21, phase = \"30 deg\" }\n"
                                           "motor_error = { amplitude = \"2 um\" }"))
                        .axes[0];
  const auto& transmission = *axis.transmission;
  EXPECT_EQ(transmission.stiffness_loss, 0.15);
  EXPECT_EQ(*transmission.warming_time, 300.0);
  EXPECT_EQ(transmission.gear_error->order, 21.0);
  EXPECT_NEAR(transmission.gear_error->phase, 0.5235987755983, 1e-12);
  EXPECT_EQ(transmission.motor_error->amplitude, 2e-6);
  EXPECT_EQ(transmission.motor_error->order, 1.0);
  EXPECT_FALSE(transmission.output_error);
  expect_refused(gear(shaft + "stiffness_loss = 0.15"), "axis.B.transmission.warming_time", "it together with");
  expect_refused(gear(shaft + "gear_error = { amplitude = \"3 um\" }"), "axis.B.transmission.gear_ratio",
                 "it together with transmission.gear_error, a table");
  expect_refused(gear("motor_error = { amplitude = \"2 um\" }"), "axis.B.transmission.motor_error",
                 "none without stiffness");
}

TEST(AxisRules, TheMotorsFrictionIsAPartOfAStiffAxis) {
  const std::string motor_friction = R"([axis.B.motor_friction]
use = "coulomb_viscous"
[axis.B.motor_friction.coulomb_viscous]
coulomb = "0.1 N m"
viscous = "1e-3 N m s/rad"
)";
  const auto axis = read_text(belt + pd + motor_friction).axes[0];
  const auto& sum = axis.friction.models.at("classical");
  const double coulomb = 0.1 / motor_way;
  EXPECT_NEAR(sum.at("coulomb")[0], 10.0 + coulomb, 1e-9);
  EXPECT_NEAR(sum.at("static_ratio")[0], (15.0 + coulomb) / (10.0 + coulomb), 1e-12);
  EXPECT_NEAR(sum.at("viscous")[0], 20.0 + 1e-3 / (motor_way * motor_way), 1e-9);
  const auto ramp = replaced(replaced(belt, "use = \"classical\"", "use = \"linear_ramp\""),
                             "[axis.B.friction.classical]\ncoulomb = \"10 N\"\nstatic_ratio = 1.5",
                             "[axis.B.friction.linear_ramp]\ncoulomb = \"10 N\"\nslope = \"1000 N s/m\"");
  expect_refused(ramp + pd + motor_friction, "axis.B.friction.use: found \"linear_ramp\"", "or transmission.stiffness");
}

TEST(AxisRules, AWeightIsHeldByTheMotor) {
  const auto hanging = [](const std::string& lines) { return belt + pd + "[axis.B.gravity]\n" + lines; };
  const auto axis = read_text(hanging("force = \"98.0665 N\"\ncounterweight_mass = \"6 kg\"\n")).axes[0];
  EXPECT_NEAR(*axis.gravity->counterweight, 58.8399, 1e-9);
  EXPECT_NEAR(axis.mass - axis.motor_mass, 12.0, 1e-12);
  // 20 A at 0.1 N m/A on 150 mm a turn hold 83.8 N.
  expect_refused(
      hanging("force = \"98.0665 N\"\n"), "found 98.07 N to hold, by gravity.force, \"98.0665 N\" (line 32)",
      "at most 83.78 N, which the motor holds at its limit, by motor.torque_constant, \"0.1 N m/A\" (line 13) "
      "and inverter.current_limit, \"20 A\" (line 17)");
  expect_refused(hanging("force = \"10 N\"\nzero = \"1 m\"\n"), "axis.B.gravity.zero", "does not turn");
  expect_refused(hanging(""), "axis.B.gravity.force: found no such key", "force, counterweight or counterweight_mass");
}

TEST(AxisRules, AnEndlessAxisHasAModuloInPlaceOfATravel) {
  const auto joint = stiction::test::rotary_joint;
  const auto endless = replaced(joint, "travel = \"360 deg\"", "modulo = \"360 deg\"");
  ASSERT_TRUE(read_text(endless).axes[0].modulo.has_value());
  expect_refused(with_line(joint, "travel = \"360 deg\"", "modulo = \"360 deg\""), "axis.J.modulo", "travel");
  expect_refused(replaced(endless, "modulo = \"360 deg\"", "modulo = \"100 deg\""), "axis.J.modulo",
                 "found \"100 deg\", 1137.78 increments by encoder.counts, 4096 (line 16); expected a whole number");
}

TEST(AxisRules, EncodersHaveTheirOwnPlaces) {
  const auto axis = read_text(belt + pd + "[axis.B.second_encoder]\nincrement = \"1 um\"\n" +
                              "[axis.B.velocity_encoder]\non = \"motor\"\ncounts = 1000\ndelay = \"1 ms\"\n")
                        .axes[0];
  EXPECT_EQ(axis.second_encoder->increment, 1e-6);
  EXPECT_NEAR(axis.velocity_encoder->increment, 0.15 / 1000.0, 1e-15);
  EXPECT_EQ(axis.velocity_encoder->delay, 1e-3);
  expect_refused(belt + pd + "[axis.B.second_encoder]\ncounts = 1000\n", "axis.B.second_encoder.counts",
                 "does not turn");
  expect_refused(belt + pd + "[axis.B.second_encoder]\nnoise = \"1 um\"\n", "axis.B.second_encoder.increment",
                 "or second_encoder.counts");
}

// At standstill a voltage makes a current through the resistance alone, and a supply limits the output.
TEST(AxisRules, AWeightIsHeldByTheVoltageToo) {
  const auto joint = replaced(stiction::test::rotary_joint, R"([axis.J.position_controller]
gain = "40 1/s"
[axis.J.velocity_controller]
gain = "1.5 V s/rad"
integral_time = "20 ms"
)",
                              R"([axis.J.controller]
structure = "p-voltage"
gain = "3 V/rad"
supply = "5 V"
)");
  const auto hanging = [&](const std::string& moment) {
    return joint + "[axis.J.gravity]\nmoment = \"" + moment + "\"\n";
  };
  EXPECT_EQ(error_of(hanging("0.59 N m")), "accepted");  // 0.12 N m/V make 0.6 N m of 5 V
  expect_refused(hanging("0.61 N m"), "axis.J.gravity: found 0.61 N m to hold",
                 "at most 0.6 N m, which the motor holds at its limit, by motor.torque_constant, \"0.12 N m/V\" (line "
                 "11) and controller.supply, \"5 V\"");
  const auto dc = replaced(joint, "model = \"force\"\ntorque_constant = \"0.12 N m/V\"",
                           "model = \"dc\"\ntorque_constant = \"0.48 N m/A\"\nphase_resistance = \"4 Ohm\"\n"
                           "phase_inductance = \"1 mH\"\nemf_constant = \"0.48 V s/rad\"");
  const auto limited = replaced(dc, "voltage_limit = \"12 V\"", "voltage_limit = \"12 V\"\ncurrent_limit = \"9 A\"");
  const auto weight = [&](const char* moment) { return limited + "[axis.J.gravity]\nmoment = \"" + moment + "\"\n"; };
  EXPECT_EQ(error_of(weight("0.59 N m")), "accepted");
  expect_refused(weight("0.61 N m"), "axis.J.gravity", "controller.supply, \"5 V\"");
}

TEST(AxisRules, AScrewHasALead) {
  const auto screw = replaced(belt + pd, "pulley_circumference = \"150 mm\"", "screw_inertia = \"1e-4 kg m^2\"");
  expect_refused(screw,
                 "axis.B.transmission.lead: found no such key together with screw_inertia, \"1e-4 kg m^2\" (line 9)",
                 "the lead of the screw");
  expect_refused(stiction::test::rotary_joint + "[axis.J.transmission]\nratio = 3\nscrew_inertia = \"1e-4 kg m^2\"\n",
                 "axis.J.transmission.screw_inertia: found \"1e-4 kg m^2\"", "none on a rotary axis");
}

// What contradicts is told at once, each with both keys and their lines; a key once, however often it is read.
TEST(AxisRules, AllContradictionsAreToldAtOnce) {
  const auto text = replaced(replaced(belt + pd, "pulley_circumference = \"150 mm\"\nmotor_inertia = \"6e-5 kg m^2\"",
                                      "screw_inertia = \"0 kg m^2\"\nstiffness = \"0.4 N/um\"\nbogus = 1"),
                             "travel = \"1 m\"", "travel = \"1 m\"\nmodulo = \"1 m\"");
  const auto error = error_of(text, {.experiment = {}, .set = {}, .all_errors = true});
  for (const char* each : {"modulo: found \"1 m\" together with travel, \"1 m\" (line 5); expected one of them",
                           "transmission.lead: found no such key together with screw_inertia, \"0 kg m^2\" (line 10)",
                           "transmission.damping: found no such key; expected damping or damping_ratio, together with "
                           "transmission.stiffness, \"0.4 N/um\" (line 11)",
                           "transmission.motor_inertia: found none", "transmission.bogus: found an unknown key"}) {
    const auto at = error.find(each);
    EXPECT_NE(at, std::string::npos) << each << "\n" << error;
    EXPECT_EQ(error.find(each, at + 1), std::string::npos) << "told twice: " << each;
  }
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 4) << error;
}

TEST(AxisRules, AWeightAndRoundsAreJudgedApart) {
  const auto text = replaced(stiction::test::rotary_joint, "travel = \"360 deg\"", "modulo = \"100 deg\"") +
                    "[axis.J.gravity]\nmoment = \"9 N m\"\n";
  const auto error = error_of(text, {.experiment = {}, .set = {}, .all_errors = true});
  EXPECT_NE(error.find("axis.J.gravity: found 9 N m to hold"), std::string::npos) << error;
  EXPECT_NE(error.find("axis.J.modulo: found \"100 deg\", 1137.78 increments"), std::string::npos) << error;
}

// A weight is judged by values that are right: a constant that is none makes no limit.
TEST(AxisRules, AWeightIsNotJudgedByWhatIsRefused) {
  const auto text = replaced(belt + pd, "0.1 N m/A", "0.1 N m") + "[axis.B.gravity]\nforce = \"98 N\"\n";
  EXPECT_EQ(error_of(text, {.experiment = {}, .set = {}, .all_errors = true}).find("to hold"), std::string::npos);
}

TEST(AxisRules, ARotaryAxisIsToldOfInItsOwnWords) {
  const auto joint = stiction::test::rotary_joint;
  expect_refused(replaced(joint, "inertia = \"1.5e-3 kg m^2\"\n", ""), "axis.J.inertia", "moving inertia");
  expect_refused(replaced(joint, "torque_constant = \"0.12 N m/V\"\n", ""), "axis.J.motor.torque_constant",
                 "torque constant of the whole motor");
}

}  // namespace
}  // namespace stiction::machine
