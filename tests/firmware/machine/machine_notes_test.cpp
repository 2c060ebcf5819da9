// What a machine file says twice, where the two do not quite agree.
#include "firmware/machine/file/machine_notes.hpp"

#include <gtest/gtest.h>

#include "firmware/machine/model/motor_force.hpp"
#include "sim/machine_file.hpp"

namespace stiction::machine::test {
namespace {

Machine shipped(const std::string& name, const std::vector<std::string>& set = {}) {
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/" + name + ".toml", {{}, set});
}

TEST(MachineNotes, TellTheDrivesForceConstantFromThatOfTheWindings) {
  const auto notes = machine_notes(shipped("mcfv5050ln"));
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_TRUE(
      notes[0].starts_with("Axis X: force_constant is 94 N/A, and the windings make 94.2 N/A, 3/2 of 62.8 (+0.21 %). "))
      << notes[0];
  EXPECT_EQ(notes[0].find("rounding"), std::string::npos) << "a data sheet rounds so much";
  EXPECT_TRUE(notes[1].starts_with("Axis Y: "));
}

TEST(MachineNotes, DoubtWhatNoDataSheetRoundsAway) {
  const auto notes = machine_notes(shipped("mcfv5050ln", {"axis.X.motor.force_constant=133 N/A"}));
  EXPECT_NE(notes.at(0).find("so much is no rounding"), std::string::npos) << notes.at(0);
  const auto emf = machine_notes(
      shipped("mcfv5050ln", {"axis.*.motor.force_constant=94.2 N/A", "axis.X.motor.emf_constant=36.3 V s/m"}));
  ASSERT_EQ(emf.size(), 1u);
  EXPECT_NE(emf[0].find("emf_constant is 36.3 V s/m and phase_force_constant 62.8 N/A"), std::string::npos) << emf[0];
}

TEST(MachineNotes, TellTheConstantsOfAShaftAsTheFileHasThem) {
  const auto* path = "/tests/axes/machines/geared_pid_current_loop.toml";
  const auto machine =
      sim::read_machine(std::string(STICTION_SOURCE_DIR) + path, {{}, {"axis.A.motor.torque_constant=0.2 N m/A"}});
  const auto notes = machine_notes(machine);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("emf_constant is 0.2 V s/rad and phase_torque_constant 0.13333 N m/A"), std::string::npos)
      << notes[0];
}

TEST(MachineNotes, AreSilentWhereOneConstantStandsAlone) {
  EXPECT_TRUE(machine_notes(shipped("emps")).empty());
  EXPECT_TRUE(machine_notes(shipped("mcfv5050ln", {"axis.*.motor.model=dc"})).empty());
  EXPECT_TRUE(machine_notes(shipped("mcfv5050ln", {"axis.*.motor.force_constant=94.2 N/A"})).empty());
}

TEST(ActingForceConstant, IsThatOfTheWindingsOrTheOnlyOne) {
  const auto table = shipped("mcfv5050ln");
  EXPECT_DOUBLE_EQ(acting_force_constant(table.axes[0].motor), 94.2);
  EXPECT_DOUBLE_EQ(largest_force(table.axes[1]), 94.2 * 140.0);  // two motors of 70 A
  EXPECT_EQ(acting_force_constant(shipped("mcfv5050ln", {"axis.*.motor.model=dc"}).axes[0].motor), 94.0);
  const auto emps = shipped("emps");
  EXPECT_EQ(acting_force_constant(emps.axes[0].motor), 35.15065188248547);
  EXPECT_DOUBLE_EQ(largest_force(emps.axes[0]), 351.5065188248547);
}

}  // namespace
}  // namespace stiction::machine::test
