// Rotary axes and transmissions: the linear axis that a file's own quantities become.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/machine_file.hpp"
#include "tests/firmware/machine/machine_text.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::machine {
namespace {

using stiction::test::joint_on_circle;
using stiction::test::rotary_joint;
using test::error_of;
using test::read_text;
using test::replaced;
using test::small_machine;

TEST(AxisKinds, ARotaryAxisIsTheLinearOneOnItsCircle) {
  const auto joint = read_text(rotary_joint).axes[0];
  ASSERT_TRUE(joint.coordinate.rotary());
  const double radius = joint.coordinate.radius;
  EXPECT_EQ(std::exp2(std::round(std::log2(radius))), radius);
  const auto linear = read_text(joint_on_circle(radius)).axes[0];
  EXPECT_EQ(joint.mass, linear.mass);
  EXPECT_EQ(joint.travel, linear.travel);
  EXPECT_EQ(joint.max_velocity, linear.max_velocity);
  EXPECT_EQ(joint.max_acceleration, linear.max_acceleration);
  EXPECT_EQ(joint.motor.force_constant, linear.motor.force_constant);
  EXPECT_EQ(joint.encoder.increment, linear.encoder.increment);
  EXPECT_EQ(joint.velocity_controller.gain, linear.velocity_controller.gain);
  EXPECT_EQ(joint.supervision.following_error, linear.supervision.following_error);
  EXPECT_EQ(joint.friction.models, linear.friction.models);
}

// The fastest of the joint, over-speed included, is the only key that asks for a small radius: 24 rad/s over the 8 m/s
// of a velocity, and three ticks of it over the 1.95 mm of a step.
TEST(AxisKinds, TheRadiusIsTheLargestThatTheDriveHolds) {
  const double radius = read_text(rotary_joint).axes[0].coordinate.radius;
  EXPECT_LE(24.0 * radius, 8.0);
  EXPECT_LE(24.0 * radius * 3.0 * 62.5e-6, 0x1p-9);
  const bool twice_fits = 48.0 * radius <= 8.0 && 48.0 * radius * 3.0 * 62.5e-6 <= 0x1p-9;
  EXPECT_FALSE(twice_fits);
}

// Ball screw of 10 mm with a gear of 3:2: 25.4 kg on the table, 0.4 N m/A at the motor.
const std::string screw_axis = R"(schema = "stiction.machine/1"
name = "screw"
[axis.B]
mass = "25.4 kg"
travel = "250 mm"
max_velocity = "0.5 m/s"
max_acceleration = "5 m/s^2"
[axis.B.transmission]
ratio = "3/2"
lead = "10 mm"
motor_inertia = "2.1 kg cm^2"
screw_inertia = "5e-4 kg m^2"
[axis.B.motor]
model = "synchronous"
phase_resistance = "1.8 Ohm"
phase_inductance = "18 mH"
mutual_inductance = "1.8 mH"
emf_constant = "0.2666667 V s/rad"
phase_torque_constant = "0.2666667 N m/A"
torque_constant = "0.4 N m/A"
pole_pairs = 4
[axis.B.inverter]
dead_time = "125 us"
voltage_limit = "320 V"
current_limit = "10 A"
[axis.B.encoder]
on = "motor"
counts = 10000
[axis.B.position_controller]
gain = "40 1/s"
[axis.B.velocity_controller]
gain = "100 A s/m"
integral_time = "10 ms"
[axis.B.current_controller]
gain = "35 V/A"
integral_time = "2 ms"
[axis.B.friction]
use = "coulomb_viscous"
[axis.B.friction.coulomb_viscous]
coulomb = "50 N"
viscous = "300 N s/m"
)";

// By the textbook: a motor turn moves the table by two thirds of the lead; inertia over (way of a radian)^2 is mass.
TEST(AxisKinds, AScrewReducesMotorAndInertiasToTheTable) {
  const auto axis = read_text(screw_axis).axes[0];
  constexpr double turn = 2.0 * std::numbers::pi;
  const double per_motor_radian = 10e-3 / 1.5 / turn, per_screw_radian = 10e-3 / turn;
  EXPECT_NEAR(axis.mass, 25.4 + 2.1e-4 / std::pow(per_motor_radian, 2) + 5e-4 / std::pow(per_screw_radian, 2),
              1e-9 * axis.mass);
  EXPECT_EQ(axis.load_mass, 25.4);
  EXPECT_NEAR(axis.motor.force_constant, 0.4 / per_motor_radian, 1e-9 * axis.motor.force_constant);
  EXPECT_NEAR(axis.motor.emf_constant, 0.2666667 / per_motor_radian, 1e-6 * axis.motor.emf_constant);
  EXPECT_NEAR(axis.motor.pole_pair_pitch, 10e-3 / 1.5 / 4.0, 1e-15);
  EXPECT_NEAR(axis.encoder.increment, 10e-3 / 1.5 / 10000.0, 1e-18);
  EXPECT_EQ(axis.velocity_controller.gain, 100.0);  // keys of the axis stay those of the axis
}

TEST(AxisKinds, TransmissionsThatContradictThemselvesAreToldTogether) {
  EXPECT_NE(error_of(replaced(screw_axis, "lead = \"10 mm\"\n", "")).find("transmission.lead: found no such key"),
            std::string::npos);
  const auto both =
      error_of(replaced(screw_axis, "lead = \"10 mm\"", "lead = \"10 mm\"\npulley_circumference = \"1 m\""));
  EXPECT_NE(both.find("\"1 m\" together with lead, \"10 mm\" (line 10)"), std::string::npos) << both;
  const auto rotary =
      error_of(replaced(rotary_joint, "[axis.J.motor]", "[axis.J.transmission]\nlead = \"1 mm\"\n[axis.J.motor]"));
  EXPECT_NE(rotary.find("none on a rotary axis"), std::string::npos) << rotary;
}

TEST(AxisKinds, CountsNeedSomethingThatTurns) {
  const auto counts = error_of(replaced(small_machine, "increment = \"50 nm\"", "counts = 1000"));
  EXPECT_NE(counts.find("expected increment in its place"), std::string::npos) << counts;
  const auto both = error_of(replaced(rotary_joint, "counts = 4096", "counts = 4096\nincrement = \"1 urad\""));
  EXPECT_NE(both.find("one of them"), std::string::npos) << both;
  const auto none = error_of(replaced(rotary_joint, "counts = 4096", ""));
  EXPECT_NE(none.find("or encoder.counts"), std::string::npos) << none;
}

TEST(AxisKinds, KeysOfTheOtherKindAreRefusedByName) {
  const auto mass = error_of(replaced(rotary_joint, "inertia = \"1.5e-3 kg m^2\"", "mass = \"1 kg\""));
  EXPECT_NE(mass.find("axis.J.mass: found an unknown key"), std::string::npos) << mass;
  const auto unit = error_of(replaced(rotary_joint, "max_velocity = \"20 rad/s\"", "max_velocity = \"20 m/s\""));
  EXPECT_NE(unit.find("rad"), std::string::npos) << unit;
}

}  // namespace
}  // namespace stiction::machine
