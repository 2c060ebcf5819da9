// Reading a valid machine file: defaults, motor models, experiments and values from the command line.
#include "sim/machine_file.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine {
namespace {

using test::read_text;
using test::small_machine;

double lugre_coulomb(const Machine& machine, std::size_t axis = 0) {
  return sim::parameters_of<sim::LuGre<>>(machine.axes[axis].friction).coulomb;
}

Machine read_shipped(std::vector<std::string> set, const std::string& experiment = {}) {
  return sim::read_machine(test::shipped_machine(), {.experiment = experiment, .set = std::move(set)});
}

TEST(MachineFile, ForceMotorTakesItsQuantitiesPerVolt) {
  const Machine machine = read_text(small_machine);
  EXPECT_EQ(machine.id, "machine");
  ASSERT_EQ(machine.axes.size(), 1u);
  const AxisModel& axis = machine.axes[0];
  EXPECT_EQ(axis.motor.model, MotorModel::force);
  EXPECT_EQ(axis.motor.force_constant, 35.0);
  EXPECT_EQ(axis.velocity_controller.gain, 243.0);
  EXPECT_EQ(axis.encoder.velocity, VelocitySource::mean_difference);
  EXPECT_FALSE(axis.current_controller);
}

TEST(MachineFile, KeysLeftOutTakeTheirDefaults) {
  const Machine machine = read_text(small_machine);
  const AxisModel& axis = machine.axes[0];
  EXPECT_EQ(machine.timing.fast_period, 62.5e-6);
  EXPECT_EQ(machine.timing.slow_period, 1e-3);
  EXPECT_EQ(axis.motor.count, 1);
  EXPECT_EQ(axis.inverter.current_limit, std::numeric_limits<double>::infinity());
  EXPECT_EQ(axis.encoder.noise, 0.0);
  EXPECT_FALSE(axis.encoder.mount);
  EXPECT_EQ(axis.position_controller.increment, 0.0);
  EXPECT_FALSE(axis.velocity_controller.integral_time);
  EXPECT_FALSE(axis.notch);
  EXPECT_EQ(axis.feedforward.velocity, 0.0);
  EXPECT_FALSE(axis.supervision.over_speed);
  EXPECT_EQ(sim::parameters_of<sim::LuGre<>>(axis.friction).static_ratio, 1.0);
  EXPECT_TRUE(machine.circle_references.empty());
}

TEST(MachineFile, DcMotorMayCarryTheKeysOfASynchronousOne) {
  const Machine machine = read_shipped({"axis.X.motor.model=dc"});
  EXPECT_EQ(machine.axes[0].motor.model, MotorModel::dc);
  EXPECT_EQ(machine.axes[0].motor.pole_pair_pitch, 72e-3);
}

TEST(MachineFile, AxesKeepTheOrderOfTheFile) {
  const Machine machine = read_text(small_machine + R"([axis.A]
mass = "1 kg"
travel = "1 m"
max_velocity = "1 m/s"
max_acceleration = "1 m/s^2"
motor = { model = "force", force_constant = "1 N/V" }
inverter = { dead_time = "0 s", voltage_limit = "1 V" }
encoder = { increment = "0 m" }
position_controller = { gain = "1 1/s" }
velocity_controller = { gain = "1 V s/m", integral_time = "1 s" }
supervision = { following_error = "3 mm", over_speed = "2 m/s" }
friction = { use = "parabolic", parabolic = { force_at_1_m_per_s = "3 N", order = 4 } }
)");
  ASSERT_EQ(machine.axes.size(), 2u);
  EXPECT_EQ(machine.axes[0].name, "B");
  EXPECT_EQ(machine.axes[1].name, "A");
  EXPECT_EQ(machine.axes[1].velocity_controller.integral_time, 1.0);
  EXPECT_EQ(machine.axes[1].supervision.following_error, 3e-3);
  EXPECT_EQ(machine.axes[1].encoder.velocity, VelocitySource::estimated);
}

TEST(MachineFile, SetChangesOneKey) {
  const Machine machine =
      read_shipped({"axis.X.mass=230 kg", "axis.Y.encoder.velocity=estimated", "axis.X.friction.use=\"classical\"",
                    "axis.X.feedforward.velocity=0.5", "timing.slow_period = 0.5 ms"});
  EXPECT_EQ(machine.axes[0].mass, 230.0);
  EXPECT_EQ(machine.axes[1].mass, 520.0);
  EXPECT_EQ(machine.axes[1].encoder.velocity, VelocitySource::estimated);
  EXPECT_EQ(machine.axes[0].friction.use, "classical");
  EXPECT_EQ(machine.axes[0].feedforward.velocity, 0.5);
  EXPECT_EQ(machine.timing.slow_period, 0.5e-3);
}

TEST(MachineFile, SetWithAStarChangesEveryAxis) {
  const Machine machine = read_shipped({"axis.*.friction.lugre.coulomb=77 N"});
  EXPECT_EQ(lugre_coulomb(machine, 0), 77.0);
  EXPECT_EQ(lugre_coulomb(machine, 1), 77.0);
}

TEST(MachineFile, SetTakesListsAndTables) {
  const Machine machine = read_shipped({"axis.X.friction.maxwell_slip.level=['1 N', '2 N']",
                                        "axis.X.friction.maxwell_slip.stiffness=['1e6 N/m', '1e5 N/m']",
                                        "axis.X.supervision={following_error = '1 mm'}"});
  const auto& slip = sim::parameters_of<sim::MaxwellSlip<>>(machine.axes[0].friction);
  EXPECT_EQ(slip.level, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(machine.axes[0].supervision.following_error, 1e-3);
}

TEST(MachineFile, LaterSetWins) {
  EXPECT_EQ(read_shipped({"axis.X.mass=230 kg", "axis.*.mass=240 kg"}).axes[0].mass, 240.0);
  EXPECT_EQ(read_shipped({"axis.*.mass=240 kg", "axis.X.mass=230 kg"}).axes[0].mass, 230.0);
}

TEST(MachineFile, SetComesAfterTheExperiment) {
  EXPECT_EQ(lugre_coulomb(read_shipped({}, "impact")), 115.0);
  EXPECT_EQ(lugre_coulomb(read_shipped({"axis.X.friction.lugre.coulomb=100 N"}, "impact")), 100.0);
  EXPECT_EQ(lugre_coulomb(read_shipped({"axis.X.mass=230 kg"}, "impact")), 115.0);
}

TEST(MachineFile, EmptySetRemovesAnOptionalKeyOrTable) {
  const Machine machine =
      read_shipped({"axis.X.notch=", "axis.*.velocity_controller.integral_time=", "axis.Y.encoder.mount="});
  EXPECT_FALSE(machine.axes[0].notch);
  EXPECT_TRUE(machine.axes[1].notch);
  EXPECT_FALSE(machine.axes[0].velocity_controller.integral_time);
  EXPECT_FALSE(machine.axes[1].velocity_controller.integral_time);
  EXPECT_FALSE(machine.axes[1].encoder.mount);
}

TEST(MachineFile, ShippedMachineCanBeTurnedIntoAForceMachine) {
  const Machine machine = read_shipped({"axis.X.motor.model=force", "axis.X.motor.force_constant=35 N/V",
                                        "axis.X.velocity_controller.gain=243 V s/m",
                                        "axis.X.current_controller=", "axis.X.friction_compensation="});
  EXPECT_EQ(machine.axes[0].motor.force_constant, 35.0);
  EXPECT_FALSE(machine.axes[0].current_controller);
}

TEST(MachineFile, ExperimentMayAddATableThatTheAxisLacks) {
  const std::string text = small_machine + "[experiment.impact.axis.B.supervision]\nfollowing_error = \"9 mm\"\n";
  EXPECT_FALSE(read_text(text).axes[0].supervision.following_error);
  EXPECT_EQ(read_text(text, {.experiment = "impact", .set = {}}).axes[0].supervision.following_error, 9e-3);
}

}  // namespace
}  // namespace stiction::machine
