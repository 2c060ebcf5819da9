// What a machine file asks of motor and power stage, against what the power stages of a bus have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "firmware/stictiond/run.hpp"

namespace stiction::test {
namespace {

using ::testing::HasSubstr;

constexpr MotorSignalSet all{
    .hall = true, .dc_link = true, .motor_temperature = true, .stage_temperature = true, .torque_off = true};

std::string refusal(const std::string& setting, const MotorSignalSet& of_x) {
  drive::DriveOptions options;
  options.machine = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";
  options.set = {setting};
  const std::array sets{of_x, all};
  try {
    drive::check_motor_inputs(drive::read_configuration(options), sets);
  } catch (const drive::StartRefused& error) {
    return error.what();
  }
  return "";
}

struct Asked {
  const char* setting;
  bool MotorSignalSet::*signal;
  const char* said;
};
const std::array asked{
    Asked{"drive.axis.X.commutation.method=hall", &MotorSignalSet::hall, "nothing that gives the Hall signals"},
    Asked{"drive.axis.X.protection.dc_link_high=800 V", &MotorSignalSet::dc_link, "the voltage of the DC link"},
    Asked{"drive.axis.X.protection.dc_link_low=100 V", &MotorSignalSet::dc_link, "protection.dc_link_low"},
    Asked{"drive.axis.X.protection.motor_temperature=130 degC", &MotorSignalSet::motor_temperature,
          "the motor's temperature"},
    Asked{"drive.axis.X.protection.stage_temperature=90 degC", &MotorSignalSet::stage_temperature,
          "the power stage's temperature"},
    Asked{"drive.axis.X.protection.torque_off=two-channels", &MotorSignalSet::torque_off,
          "lines torque_off_a and torque_off_b"},
};

TEST(MotorInputs, StartWithAllThatTheFileAsksFor) {
  for (const auto& row : asked) EXPECT_EQ(refusal(row.setting, all), "") << row.setting;
  EXPECT_EQ(refusal("axis.X.mass=100 kg", {}), "") << "nothing is asked for";
}

TEST(MotorInputs, RefuseTheStartWhereOneIsMissingAndNameIt) {
  for (const auto& row : asked) {
    SCOPED_TRACE(row.setting);
    auto lacking = all;
    lacking.*row.signal = false;
    EXPECT_THAT(refusal(row.setting, lacking), HasSubstr("mcfv5050ln.toml: found drive.axis.X."));
    EXPECT_THAT(refusal(row.setting, lacking), HasSubstr(row.said));
  }
}

}  // namespace
}  // namespace stiction::test
