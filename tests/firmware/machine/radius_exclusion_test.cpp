// A rotary axis for which no radius serves: what excludes one another, and that the firmware alone has no use for it.
#include <gtest/gtest.h>

#include <string>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/file/machine_notes.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/machine/machine_text.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::machine {
namespace {

using test::read_text;
using test::replaced;

Machine arm() {
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/tests/axes/machines/elastic_arm_gravity_cascade.toml");
}

// The over-speed limit of 2400 rad/s stays below the 8 m/s of a velocity and, over three ticks, below the 1.95 mm of a
// step up to 2^-9 m: 2400 / 512 * 3 * 62.5e-6 = 0.88 mm. A gain of 1500 V s/rad is 12000 V s/m at 2^-3 m.
TEST(RadiusExclusion, NamesTheTwoKeysWithValueLineAndRadius) {
  const auto text =
      replaced(replaced(stiction::test::rotary_joint, "20 rad/s", "2000 rad/s"), "1.5 V s/rad", "1500 V s/rad");
  EXPECT_EQ(read_text(text).axes[0].beyond_formats,
            "axis.J: found max_velocity, \"2000 rad/s\" (line 7) with its over-speed limit, which needs a radian of at "
            "most 0.00195312 m, together with velocity_controller.gain, \"1500 V s/rad\" (line 20), which needs one of "
            "at least 0.125 m; expected values that the firmware's number formats hold on one radius, or a run in "
            "double precision (simulate replay --signals double)");
  // Each of them alone has a radius, and it is within the bound that the sentence names.
  const auto fast = read_text(replaced(stiction::test::rotary_joint, "20 rad/s", "2000 rad/s"));
  EXPECT_TRUE(fast.fits_formats());
  EXPECT_LE(fast.axes[0].coordinate.radius, 0x1p-9);
  const auto stiff = read_text(replaced(stiction::test::rotary_joint, "1.5 V s/rad", "1500 V s/rad"));
  EXPECT_TRUE(stiff.fits_formats());
  EXPECT_GE(stiff.axes[0].coordinate.radius, 0x1p-3);
}

TEST(RadiusExclusion, AnAxisWithoutLimitsIsToldToHaveThem) {
  const std::string reason = arm().axes[0].beyond_formats;
  EXPECT_NE(reason.find("axis.A: found no table [axis.A.inverter], so that neither current nor voltage has a limit"),
            std::string::npos)
      << reason;
  EXPECT_EQ(reason.find("over_current"), std::string::npos) << reason;
}

TEST(RadiusExclusion, IsTheFirmwaresAlone) {
  const auto machine = arm();
  EXPECT_FALSE(machine.fits_formats());
  EXPECT_NO_THROW(configure_axis<DoubleSignals>(machine.timing, machine.axes[0]));
  try {
    configure_axis<FixedSignals>(machine.timing, machine.axes[0]);
    FAIL();
  } catch (const ConfigurationError& error) {
    EXPECT_EQ(error.what(), machine.axes[0].beyond_formats);
  }
  const auto notes = machine_notes(machine);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find(machine.axes[0].beyond_formats), std::string::npos);
}

// A joint that fits says nothing; a gain of its position loop beyond the format is no matter of a radius.
TEST(RadiusExclusion, IsNoneWhereARadiusServes) {
  EXPECT_TRUE(read_text(stiction::test::rotary_joint).fits_formats());
  const auto reason = read_text(replaced(stiction::test::rotary_joint, "gain = \"40 1/s\"", "gain = \"1e9 1/s\""))
                          .axes[0]
                          .beyond_formats;
  EXPECT_NE(reason.find("found position_controller.gain, \"1e9 1/s\" (line 18), which no radius serves"),
            std::string::npos)
      << reason;
}

}  // namespace
}  // namespace stiction::machine
