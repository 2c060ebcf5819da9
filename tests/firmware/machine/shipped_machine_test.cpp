// The shipped cross table carries the values of the thesis (Mendricky 2006; table numbers are its own).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "sim/machine_file.hpp"
#include "sim/plant/friction/laws.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine {
namespace {

using test::shipped_machine;

const Machine& cross_table() {
  static const Machine machine = sim::read_machine(shipped_machine());
  return machine;
}

template <class Law>
typename Law::Parameters friction(const AxisModel& axis) {
  return sim::parameters_of<Law>(axis.friction);
}

TEST(ShippedCrossTable, HasTheAxesXAndYInThisOrder) {
  EXPECT_EQ(cross_table().name, "MCFV 5050 LN cross table");
  EXPECT_EQ(cross_table().id, "mcfv5050ln");
  ASSERT_EQ(cross_table().axes.size(), 2u);
  EXPECT_EQ(cross_table().axes[0].name, "X");
  EXPECT_EQ(cross_table().axes[1].name, "Y");
  EXPECT_EQ(cross_table().timing.fast_period, 62.5e-6);
  EXPECT_EQ(cross_table().timing.slow_period, 1e-3);
}

TEST(ShippedCrossTable, CarriesMotorAndMechanicsOfTables31And33) {
  const AxisModel& x = cross_table().axes[0];
  const AxisModel& y = cross_table().axes[1];
  EXPECT_EQ(x.mass, 225.0);
  EXPECT_EQ(y.mass, 520.0);
  EXPECT_EQ(x.travel, 0.5);
  EXPECT_EQ(y.travel, 0.4);
  EXPECT_EQ(x.motor.count, 1);
  EXPECT_EQ(y.motor.count, 2);
  for (const AxisModel& axis : cross_table().axes) {
    EXPECT_EQ(axis.max_velocity, 80.0 / 60.0);
    EXPECT_EQ(axis.max_acceleration, 20.0);
    EXPECT_EQ(axis.motor.model, MotorModel::synchronous);
    EXPECT_EQ(axis.motor.phase_resistance, 1.8);
    EXPECT_EQ(axis.motor.phase_inductance, 18e-3);
    EXPECT_EQ(axis.motor.mutual_inductance, 1.8e-3);
    EXPECT_EQ(axis.motor.emf_constant, 62.8);
    EXPECT_EQ(axis.motor.phase_force_constant, 62.8);
    EXPECT_EQ(axis.motor.force_constant, 94.0);
    EXPECT_EQ(axis.motor.pole_pair_pitch, 72e-3);
    EXPECT_EQ(axis.inverter.dead_time, 125e-6);
    EXPECT_EQ(axis.inverter.voltage_limit, 600.0);
    EXPECT_EQ(axis.inverter.current_limit, 70.0);
    EXPECT_EQ(axis.encoder.increment, 1e-9);
    EXPECT_EQ(axis.encoder.noise, 0.0);
    EXPECT_EQ(axis.encoder.velocity, VelocitySource::ideal);
    ASSERT_TRUE(axis.encoder.mount);
    EXPECT_EQ(axis.encoder.mount->mass, 0.5);
    EXPECT_EQ(axis.encoder.mount->natural_frequency, 2000.0);
    EXPECT_EQ(axis.encoder.mount->damping_ratio, 0.05);
  }
}

TEST(ShippedCrossTable, CarriesTheControllersOfTable32) {
  const AxisModel& x = cross_table().axes[0];
  const AxisModel& y = cross_table().axes[1];
  EXPECT_EQ(x.velocity_controller.gain, 600.0);
  EXPECT_EQ(x.velocity_controller.integral_time, 5e-3);
  EXPECT_EQ(y.velocity_controller.gain, 1200.0);
  EXPECT_EQ(y.velocity_controller.integral_time, 4.4e-3);
  ASSERT_TRUE(x.current_controller && y.current_controller);
  EXPECT_EQ(x.current_controller->gain, 35.0);
  EXPECT_EQ(y.current_controller->gain, 17.0);
  for (const AxisModel& axis : cross_table().axes) {
    EXPECT_NEAR(axis.position_controller.gain, 5.0 / 60.0 * 1000.0, 1e-4);  // printed with two more digits
    EXPECT_EQ(axis.position_controller.increment, 1e-6);
    EXPECT_EQ(axis.current_controller->integral_time, 2e-3);
    ASSERT_TRUE(axis.notch);
    EXPECT_EQ(axis.notch->frequency, 2000.0);
    EXPECT_EQ(axis.notch->numerator_damping, 0.05);
    EXPECT_EQ(axis.notch->denominator_damping, 0.7);
    EXPECT_EQ(axis.feedforward.velocity, 1.0);
    EXPECT_EQ(axis.feedforward.current, 1.0);
    EXPECT_FALSE(axis.supervision.following_error);
  }
}

TEST(ShippedCrossTable, CarriesTheFrictionOfTable63) {
  const double coulomb[] = {90.0, 220.0}, viscous[] = {500.0, 1250.0}, slope[] = {12000.0, 29000.0},
               root[] = {300.0, 800.0}, stiffness[] = {8e5, 2e6};
  for (std::size_t i = 0; i < 2; ++i) {
    const AxisModel& axis = cross_table().axes[i];
    EXPECT_EQ(axis.friction.use, "lugre");
    EXPECT_EQ(axis.friction.models.size(), std::variant_size_v<sim::FrictionModel>);
    EXPECT_EQ(friction<sim::CoulombViscous<>>(axis).coulomb, coulomb[i]);
    EXPECT_EQ(friction<sim::CoulombViscous<>>(axis).viscous, viscous[i]);
    EXPECT_EQ(friction<sim::Classical<>>(axis).coulomb, coulomb[i]);
    EXPECT_EQ(friction<sim::Classical<>>(axis).static_ratio, 1.0);
    EXPECT_EQ(friction<sim::Classical<>>(axis).viscous, viscous[i]);
    const auto& ramp = friction<sim::LinearRamp<>>(axis);
    EXPECT_EQ(ramp.slope, slope[i]);
    EXPECT_EQ(ramp.viscous, viscous[i]);
    // The table prints the break velocity as 0.45 m/min, rounded to two digits.
    EXPECT_NEAR(ramp.coulomb / ramp.slope * 60.0, 0.45, 0.0055);
    EXPECT_EQ(friction<sim::Parabolic<>>(axis).force_at_1_m_per_s, root[i]);
    EXPECT_EQ(friction<sim::Parabolic<>>(axis).order, 3.0);
    const auto& lugre = friction<sim::LuGre<>>(axis);
    EXPECT_EQ(lugre.coulomb, coulomb[i]);
    EXPECT_EQ(lugre.static_ratio, 1.0);
    EXPECT_EQ(lugre.viscous, viscous[i]);
    EXPECT_EQ(lugre.stribeck_velocity, 1e-3);
    EXPECT_EQ(lugre.stiffness, stiffness[i]);
    EXPECT_EQ(lugre.damping_ratio, 0.1);
  }
}

// Tab 5.3 B, force over displacement, scaled from 100 N to the axis' F_C; Y also by its contact stiffness.
TEST(ShippedCrossTable, MaxwellSlipElementsFollowTheMeasuredPreslidingCurve) {
  const double displacement_um[] = {0.3, 2.0, 6.3, 20.0, 47.0}, force[] = {20.0, 40.0, 60.0, 80.0, 100.0};
  const double force_scale[] = {0.9, 2.2}, displacement_scale[] = {1.0, 220.0 / 90.0 / 2.5};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto& slip = friction<sim::MaxwellSlip<>>(cross_table().axes[axis]);
    ASSERT_EQ(slip.level.size(), 5u);
    EXPECT_NEAR(std::accumulate(slip.level.begin(), slip.level.end(), 0.0), 100.0 * force_scale[axis], 1e-9);
    for (std::size_t point = 0; point < 5; ++point) {
      double sum = 0.0;
      for (std::size_t i = 0; i < slip.level.size(); ++i)
        sum += std::min(slip.level[i], slip.stiffness[i] * displacement_um[point] * 1e-6 * displacement_scale[axis]);
      EXPECT_NEAR(sum, force[point] * force_scale[axis], 0.05) << "the file gives four digits";
    }
  }
}

TEST(ShippedCrossTable, ConstantVelocityAndImpactUseTable61OnX) {
  for (const char* experiment : {"impact", "constant-velocity"}) {
    const Machine machine = sim::read_machine(shipped_machine(), {.experiment = experiment, .set = {}});
    const AxisModel& x = machine.axes[0];
    EXPECT_EQ(x.mass, 225.0);
    EXPECT_EQ(friction<sim::CoulombViscous<>>(x).coulomb, 115.0);
    EXPECT_EQ(friction<sim::Classical<>>(x).coulomb, 115.0);
    EXPECT_EQ(friction<sim::Classical<>>(x).viscous, 430.0);
    EXPECT_EQ(friction<sim::LinearRamp<>>(x).coulomb, 115.0);
    EXPECT_EQ(friction<sim::LinearRamp<>>(x).slope, 12000.0);
    EXPECT_EQ(friction<sim::LinearRamp<>>(x).viscous, 430.0);
    EXPECT_EQ(friction<sim::Parabolic<>>(x).order, 4.0);
    EXPECT_EQ(friction<sim::Parabolic<>>(x).force_at_1_m_per_s, 300.0);
    EXPECT_EQ(friction<sim::LuGre<>>(x).stiffness, 1e7);
    EXPECT_EQ(friction<sim::LuGre<>>(x).coulomb, 115.0);
    EXPECT_EQ(friction<sim::LuGre<>>(x).stribeck_velocity, 1e-3);
    const auto& slip = friction<sim::MaxwellSlip<>>(x);
    EXPECT_NEAR(std::accumulate(slip.level.begin(), slip.level.end(), 0.0), 115.0, 1e-9);
    EXPECT_EQ(friction<sim::LuGre<>>(machine.axes[1]).coulomb, 220.0);
  }
}

TEST(ShippedCrossTable, OtherExperimentsLeaveTheFileAsItStands) {
  const Machine machine = sim::read_machine(shipped_machine(), {.experiment = "circle", .set = {}});
  EXPECT_EQ(friction<sim::LuGre<>>(machine.axes[0]).coulomb, 90.0);
}

TEST(ShippedCrossTable, HoldsAllRowsOfTable64) {
  const auto& rows = cross_table().circle_references;
  ASSERT_EQ(rows.size(), 50u);
  double error_um = 0.0, current = 0.0;
  std::map<std::string, int> count;
  for (const CircleReference& row : rows) {
    error_um += row.error * 1e6;
    current += row.current;
    ++count[row.axis + " " + (row.measured ? "measured" : row.friction.value())];
  }
  for (const char* axis : {"X", "Y"})
    for (const char* source : {"measured", "classical", "linear_ramp", "parabolic", "lugre"})
      EXPECT_EQ(count[std::string(axis) + " " + source], 5) << axis << " " << source;
  // Sums of the printed table's rows.
  EXPECT_NEAR(error_um, (39.5 + 61 + 38 + 36 + 39) + (44.5 + 70 + 44 + 45 + 46), 1e-6);
  EXPECT_NEAR(current, (32.6 + 32.9 + 31.3 + 31.0 + 31.5) + (78.4 + 78.2 + 74.1 + 75.0 + 74.8), 1e-9);
}

TEST(ShippedCrossTable, ReferenceRowIsFoundByAxisSourceAndFeed) {
  const CircleReference* lugre = nullptr;
  const CircleReference* measured = nullptr;
  for (const CircleReference& row : cross_table().circle_references) {
    if (row.axis != "Y" || row.feed != 24.0 / 60.0) continue;
    if (row.measured) measured = &row;
    if (row.friction == "lugre") lugre = &row;
  }
  ASSERT_TRUE(lugre != nullptr && measured != nullptr);
  EXPECT_EQ(lugre->error, 12e-6);
  EXPECT_EQ(lugre->current, 13.8);
  EXPECT_EQ(measured->error, 10.5e-6);
  EXPECT_EQ(measured->current, 13.5);
  EXPECT_FALSE(measured->friction);
}

class ShippedFolder : public testing::Test {
 protected:
  ShippedFolder() { setenv("STICTION_MACHINES", ("/nowhere:" + shipped_machine().parent_path().string()).c_str(), 1); }
  ~ShippedFolder() override { unsetenv("STICTION_MACHINES"); }
};

TEST_F(ShippedFolder, NameFindsTheShippedFile) { EXPECT_EQ(find_machine("mcfv5050ln"), shipped_machine()); }

TEST_F(ShippedFolder, PathStaysAPath) {
  EXPECT_EQ(find_machine("mine.toml"), "mine.toml");
  EXPECT_EQ(find_machine("folder/mine"), "folder/mine");
  EXPECT_EQ(find_machine(shipped_machine().string()), shipped_machine());
}

TEST_F(ShippedFolder, ShippedMachinesAreListedByName) {
  const auto names = shipped_machines();
  EXPECT_EQ(std::count(names.begin(), names.end(), "mcfv5050ln"), 1);
}

TEST_F(ShippedFolder, UnknownNameListsTheShippedMachines) {
  try {
    find_machine("mcfv5050");
    FAIL() << "found";
  } catch (const MachineFileError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("machine \"mcfv5050\": found no such machine; expected"))
        << error.what();
    EXPECT_TRUE(std::string(error.what()).ends_with("did you mean \"mcfv5050ln\"?")) << error.what();
  }
}

}  // namespace
}  // namespace stiction::machine
