// The generated reference of the machine file.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "firmware/machine/file/parameters.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::machine {
namespace {

// The part of the page under the table's heading.
std::string section(const std::string& page, const std::string& table) {
  const std::size_t start = page.find("\n## `[" + table + "]`\n");
  if (start == std::string::npos) return {};
  return page.substr(start, page.find("\n## ", start + 1) - start);
}

template <class Owner>
void expect_rows(const std::string& page, const std::string& table) {
  for (const auto& p : Table<Owner>::parameters) {
    const std::string row = "| `" + std::string(p.key) + "` | ";
    EXPECT_NE(section(page, table).find(row), std::string::npos) << table << " " << p.key;
    EXPECT_NE(section(page, table).find(std::string(p.text) + " |"), std::string::npos) << table << " " << p.key;
  }
}

TEST(ReferencePage, ListsEveryParameterOfEveryStruct) {
  const std::string page = sim::reference_page();
  expect_rows<Timing>(page, "timing");
  expect_rows<AxisModel>(page, "axis.NAME");
  expect_rows<MotorParameters>(page, "axis.NAME.motor");
  expect_rows<InverterParameters>(page, "axis.NAME.inverter");
  expect_rows<EncoderParameters>(page, "axis.NAME.encoder");
  expect_rows<EncoderMountParameters>(page, "axis.NAME.encoder.mount");
  expect_rows<PositionControllerParameters>(page, "axis.NAME.position_controller");
  expect_rows<VelocityControllerParameters>(page, "axis.NAME.velocity_controller");
  expect_rows<CurrentControllerParameters>(page, "axis.NAME.current_controller");
  expect_rows<NotchParameters>(page, "axis.NAME.notch");
  expect_rows<FeedforwardParameters>(page, "axis.NAME.feedforward");
  expect_rows<SupervisionParameters>(page, "axis.NAME.supervision");
  expect_rows<CircleReference>(page, "[reference.circle]");
  expect_rows<FeedDrive>(page, "feed_drive");
  expect_rows<FeedMotor>(page, "feed_drive.motor");
  expect_rows<FeedConverter>(page, "feed_drive.converter");
  expect_rows<FeedSpeedController>(page, "feed_drive.speed_controller");
  expect_rows<FeedCurrentController>(page, "feed_drive.current_controller");
  expect_rows<FeedCarriage>(page, "feed_drive.carriage");
  expect_rows<FeedFriction>(page, "feed_drive.friction");
  expect_rows<FeedCutting>(page, "feed_drive.cutting");
  expect_rows<FeedTool>(page, "feed_drive.tool");
  expect_rows<SteadyFrictionReference>(page, "[reference.steady_friction]");
  expect_rows<PreslidingReference>(page, "[reference.presliding]");
  sim::for_each_friction_model([&]<class Model>() {
    const std::string table = "axis.NAME.friction." + std::string(Model::name);
    for (const auto& p : Model::parameters)
      EXPECT_NE(section(page, table).find("| `" + std::string(p.key) + "` | "), std::string::npos) << table;
  });
}

TEST(ReferencePage, ShowsUnitRangeAndDefault) {
  const std::string page = sim::reference_page();
  EXPECT_NE(page.find("| `mass` | `kg` | greater than 0 kg | required | moving mass |"), std::string::npos);
  EXPECT_NE(page.find("| `count` | – | from 1 to 64 | 1 | motors in parallel on one servo module |"),
            std::string::npos);
  EXPECT_NE(page.find("| `force_constant` | `N/A`, force motor `N/V` |"), std::string::npos);
  EXPECT_NE(page.find("| `level` | list of `N` |"), std::string::npos);
  EXPECT_NE(page.find("| `pole_pair_pitch` | `m` | greater than 0 m | required with motor model \"synchronous\" |"),
            std::string::npos);
  EXPECT_NE(section(page, "axis.NAME.current_controller").find("(required with motor model \"synchronous\" or \"dc\")"),
            std::string::npos);
}

TEST(ReferencePage, EveryRowHasFiveCells) {
  const std::string page = sim::reference_page();
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| `"); at != std::string::npos; at = page.find("\n| `", at + 1)) {
    const std::string row = page.substr(at + 1, page.find('\n', at + 1) - at - 1);
    EXPECT_EQ(std::count(row.begin(), row.end(), '|'), 6) << row;
    ++rows;
  }
  std::size_t keys = 0;
  for (const TableDescription& table : sim::machine_file_description()) keys += table.keys.size();
  EXPECT_EQ(rows, keys);
}

}  // namespace
}  // namespace stiction::machine
