// How a machine file says that an axis stops: the option codes of CiA 402 by name, and its two decelerations.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware/machine/configuration/drive_configuration.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/machine/file/drive_parameters.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

const std::string stops_machine = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";

machine::DriveSetup stops_setup(const std::vector<std::string>& settings) {
  return machine::read_drive_setup(stops_machine, cross_table(), {"", settings});
}
std::string rejection_of(const std::vector<std::string>& settings) {
  try {
    machine::configure_drives<FixedSignals>(cross_table(), stops_setup(settings));
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

// Every name is a code that the firmware has, and every code that it has has a name.
TEST(StopKeys, NameEachCodeOfTheTable) {
  std::size_t named = 0;
  const auto check = [&](StopObject object, const auto& choices) {
    for (const auto& choice : choices) {
      EXPECT_NE(stop_option(object, choice.value), nullptr) << choice.name;
      ++named;
    }
  };
  check(StopObject::quick_stop, machine::quick_stop_codes);
  check(StopObject::shutdown, machine::disable_codes);
  check(StopObject::disable_operation, machine::disable_codes);
  check(StopObject::halt, machine::halt_codes);
  check(StopObject::fault_reaction, machine::fault_reaction_codes);
  EXPECT_EQ(named, stop_option_table.size());
}

TEST(StopKeys, AreTakenAndRefusedWithWhatTheDriveHas) {
  EXPECT_EQ(stops_setup({}).axes.at("X").stops.quick_stop, 2);
  const auto setup = stops_setup({"drive.axis.X.stops.quick_stop=slow-down-held", "drive.axis.X.stops.halt=quick-stop",
                                  "drive.axis.X.slow_down_deceleration=4 m/s^2"});
  EXPECT_EQ(setup.axes.at("X").stops.quick_stop, 5);
  const auto drive = machine::configure_drives<FixedSignals>(cross_table(), setup).front();
  EXPECT_EQ(drive.stops.quick_stop, 5);
  EXPECT_EQ(drive.stops.halt, 2);
  EXPECT_LT(drive.slow_down, drive.ramp.change);
  const auto said = rejection_of({"drive.axis.X.stops.quick_stop=current-limit"});
  EXPECT_NE(said.find("slow-down-held"), std::string::npos) << said;
  EXPECT_NE(said.find("current-limit"), std::string::npos) << said;
}

TEST(StopKeys, RefuseASlowRampThatIsTheFasterOne) {
  const auto said = rejection_of({"drive.axis.X.slow_down_deceleration=11 m/s^2"});
  EXPECT_NE(said.find("expected at most quick_stop_deceleration, 10 m/s^2"), std::string::npos) << said;
}

TEST(HomingKeys, NameTheHomeSwitch) {
  for (const auto& [name, method] : {std::pair{"home-positive", stiction::HomingMethod::home_positive},
                                     std::pair{"home-negative", stiction::HomingMethod::home_negative}}) {
    const auto setup = stops_setup({std::string("drive.axis.X.homing.method=") + name});
    EXPECT_EQ(machine::configure_drives<FixedSignals>(cross_table(), setup).front().homing.method, method);
  }
}

}  // namespace
}  // namespace stiction::test
