// Lists of records: what is read, and what is refused with its line.
#include "host/fleet/fleet_list.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "firmware/machine/file/machine_file.hpp"

namespace stiction::host {
namespace {

std::string refusal(const std::string& file, const std::string& text) {
  try {
    parse_fleet_list(file, text);
  } catch (const machine::MachineFileError& error) {
    return error.what();
  }
  return "nothing was refused";
}

const std::string emps = STICTION_SOURCE_DIR "/firmware/machine/shipped/emps.toml";

TEST(FleetList, OrdersRecordsByAxisAndDate) {
  const auto list = parse_fleet_list("plant/fleet.csv",
                                     "date,axis,log,machine\n"
                                     "# a comment\n"
                                     "2026-03-01,b,b3.csv," +
                                         emps +
                                         "\n"
                                         "2026-02-01,a,\"a, 2.csv\"," +
                                         emps +
                                         "\n"
                                         "\n"
                                         "2025-12-31,b,/logs/b0.csv," +
                                         emps + "\n");
  ASSERT_EQ(list.axes.size(), 2U);
  EXPECT_EQ(list.axes[0].name, "b");
  EXPECT_EQ(list.axes[1].records, (std::vector<std::size_t>{2}));
  ASSERT_EQ(list.records.size(), 3U);
  EXPECT_EQ(list.records[0].file, "/logs/b0.csv");
  EXPECT_EQ(list.records[1].place, "plant/fleet.csv:3");
  EXPECT_EQ(list.records[1].day - list.records[0].day, 60.0);
  EXPECT_EQ(list.records[2].file, "plant/a, 2.csv");
}

TEST(FleetList, ReadsToml) {
  const auto list = parse_fleet_list("fleet.toml",
                                     "schema = \"stiction.fleet-list/1\"\n[[record]]\naxis = \"a\"\n"
                                     "machine = \"" +
                                         emps +
                                         "\"\nmachine_axis = \"X\"\n"
                                         "date = \"2026-01-01\"\nlog = \"a.csv\"\n");
  ASSERT_EQ(list.records.size(), 1U);
  EXPECT_EQ(list.axes[0].machine_axis, "X");
}

TEST(FleetList, CountsDaysAsTheCalendarDoes) {
  EXPECT_EQ(day_of("1970-01-01"), 0.0);
  EXPECT_EQ(day_of("2024-03-01") - day_of("2024-02-01"), 29.0);
  for (const auto* wrong : {"2026-02-30", "2026-3-01", "yesterday", "", "2026-13-01"})
    EXPECT_THROW(day_of(wrong), std::invalid_argument) << wrong;
}

TEST(FleetList, SaysWhatIsWrongAndWhere) {
  const std::string head = "axis,machine,date,log\n";
  const auto row = [](const std::string& axis, const std::string& date) {
    return axis + "," + emps + "," + date + ",x.csv\n";
  };
  EXPECT_NE(refusal("f.csv", head).find("f.csv: found no record"), std::string::npos);
  EXPECT_NE(refusal("f.csv", "axis,machine,dat,log\n").find("f.csv:1: found the column 'dat'"), std::string::npos);
  EXPECT_NE(refusal("f.csv", "axis,machine,log\n").find("found no column 'date'"), std::string::npos);
  EXPECT_NE(refusal("f.csv", "axis,axis,log\n").find("twice"), std::string::npos);
  EXPECT_NE(refusal("f.csv", head + "a,b\n").find("f.csv:2: found 2 cells; expected 4"), std::string::npos);
  EXPECT_NE(refusal("f.csv", head + "a,\"b\n").find("quotation mark"), std::string::npos);
  EXPECT_NE(refusal("f.csv", head + row("a", "2026-02-30")).find("f.csv:2: date: found '2026-02-30'"),
            std::string::npos);
  EXPECT_NE(refusal("f.csv", head + row("", "2026-02-01")).find("f.csv:2: found no axis"), std::string::npos);
  EXPECT_NE(refusal("f.csv", head + row("a", "2026-02-01") + row("b", "2026-02-01") + row("a", "2026-02-01"))
                .find("f.csv:4: found a second record of axis a on 2026-02-01, after f.csv:2"),
            std::string::npos);
  EXPECT_NE(
      refusal("f.csv", head + row("a", "2026-02-01") + "a,other,2026-03-01,y.csv\n").find("as in its first record"),
      std::string::npos);
  EXPECT_NE(refusal("f.csv", head + "a,no-such-machine,2026-02-01,x.csv\n").find("f.csv:2: "), std::string::npos);
  EXPECT_NE(refusal("f.toml", "schema = \"other/1\"\n").find("stiction.fleet-list/1"), std::string::npos);
  EXPECT_NE(refusal("f.toml", "schema = \"stiction.fleet-list/1\"\n[[record]]\naxis = \"a\"\n").find("machine"),
            std::string::npos);
}

}  // namespace
}  // namespace stiction::host
