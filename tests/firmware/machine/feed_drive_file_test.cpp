// A machine file with a feed drive: what it holds, alone and beside axes, and what is refused.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine::test {
namespace {

std::string feed_drive_text() {
  std::ifstream in(shipped_feed_drive());
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(FeedDriveFile, ShippedOneHasAFeedDriveAndNoAxis) {
  const auto machine = read_text(feed_drive_text());
  EXPECT_TRUE(machine.axes.empty());
  ASSERT_TRUE(machine.feed_drive);
  const auto& drive = *machine.feed_drive;
  EXPECT_DOUBLE_EQ(drive.carriage.mass, 300.0);
  EXPECT_DOUBLE_EQ(drive.carriage.stiffness, 1.33e7);
  EXPECT_DOUBLE_EQ(drive.carriage.damping_ratio, 0.05);
  EXPECT_NEAR(drive.friction.step(), 2000.0, 1e-9);
  EXPECT_NEAR(drive.cutting.spindle_speed, 1000.0 * 2.0 * std::numbers::pi / 60.0, 1e-9);
  EXPECT_DOUBLE_EQ(drive.tool.exponent_x, 0.55);  // (12)
  EXPECT_DOUBLE_EQ(drive.tool.exponent_z, 0.75);
}

TEST(FeedDriveFile, StandsBesideAxes) {
  auto text = feed_drive_text();
  const auto tables = text.substr(text.find("[feed_drive]"));
  const auto machine = read_text(small_machine + tables);
  EXPECT_EQ(machine.axes.size(), 1U);
  EXPECT_TRUE(machine.feed_drive);
}

TEST(FeedDriveFile, TakesOverrides) {
  const auto set = read_text(feed_drive_text(), {.experiment = {}, .set = {"feed_drive.carriage.stiffness=4e7 N/m"}});
  EXPECT_DOUBLE_EQ(set.feed_drive->carriage.stiffness, 4e7);
  const auto overridden =
      read_text(feed_drive_text() + "[experiment.feed-cutting.feed_drive.cutting]\nspindle_speed = \"500 rpm\"\n",
                {.experiment = "feed-cutting", .set = {}});
  EXPECT_NEAR(overridden.feed_drive->cutting.revolution(), 0.12, 1e-12);
}

TEST(FeedDriveFile, RefusesWhatCannotBe) {
  const auto error = [](const std::string& from, const std::string& to) {
    return error_of(replaced(feed_drive_text(), from, to));
  };
  EXPECT_NE(error("mass = \"300 kg\"", "mass = \"300 N\"").find("feed_drive.carriage.mass: found \"300 N\""),
            std::string::npos);
  EXPECT_NE(error("[feed_drive.tool]", "[feed_drive.tools]").find("feed_drive.tool"), std::string::npos);
  EXPECT_NE(error("spindle_speed = \"1000 rpm\"", "spindle_speed = \"16 Hz\"").find("spindle_speed: found \"16 Hz\""),
            std::string::npos);
  EXPECT_NE(error("static_short = 0.2", "static_short = 0.05")
                .find("static_short: found 0.05; expected a number of at least 0.1, the value of sliding"),
            std::string::npos);
  EXPECT_NE(error("static_long = 0.3", "static_long = 0.15")
                .find("static_long: found 0.15; expected a number of at least 0.2, the value of static_short"),
            std::string::npos);
  EXPECT_EQ(error_of("schema = \"stiction.machine/1\"\nname = \"none\"\n"),
            "FILE:1: axis: found no axis; expected at least one table [axis.NAME], or a table [feed_drive]");
}

}  // namespace
}  // namespace stiction::machine::test
