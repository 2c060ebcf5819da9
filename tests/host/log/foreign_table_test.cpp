// Logs as drives and their users write them: separators, decimal commas, encodings, blank cells, no header.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/log/csv_log.hpp"
#include "host/log/read_log.hpp"
#include "host/log/text_file.hpp"
#include "tests/host/log/synthetic_log.hpp"
#include "tests/host/log/temporary_file.hpp"

namespace stiction::host {
namespace {

using test::TemporaryFile;

const std::string commas = "t[ms],x[mm],F[N]\n0,1.5,-2\n1,1.625,2.25\n2,1.75,3e-1\n";

std::string replaced_all(std::string text, char from, char to) {
  std::ranges::replace(text, from, to);
  return text;
}

std::string with_crlf(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

// The same table with decimal commas.
std::string with_decimal_commas(const std::string& text, char separator) {
  return replaced_all(replaced_all(text, ',', separator), '.', ',');
}

std::string utf16(const std::string& ascii, bool big) {
  std::string out = big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : ascii) out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

std::string refusal(const std::string& text, const std::string& columns = {}) {
  try {
    parse_csv_log(text, "run.csv", columns);
  } catch (const LogError& error) {
    return error.what();
  }
  return "";
}

void expect_refused(const std::string& text, const std::string& columns, const std::string& place,
                    const std::string& found) {
  const auto message = refusal(text, columns);
  EXPECT_TRUE(message.starts_with(place + ": ")) << message;
  EXPECT_NE(message.find(found), std::string::npos) << message;
  EXPECT_NE(message.find("; expected "), std::string::npos) << message;
}

TEST(ForeignTable, ReadsTheSameLogWithAnySeparatorDecimalMarkLineEndAndEncoding) {
  const auto log = parse_csv_log(commas, "run");
  EXPECT_EQ(log.axes[0].force, (std::vector<double>{-2.0, 2.25, 0.3}));
  for (const char separator : {';', '\t', ' '})
    for (const bool comma : {false, true}) {
      const auto table = comma ? with_decimal_commas(commas, separator) : replaced_all(commas, ',', separator);
      for (const auto& text : {table, with_crlf(table), "\xEF\xBB\xBF" + table, utf16(table, false),
                               utf16(with_crlf(table), true), "# a: b\n" + table})
        expect_same_log(
            [&] {
              auto read = parse_csv_log(text, "run");
              read.comments.clear();
              return read;
            }(),
            log);
    }
}

TEST(ForeignTable, TakesAnyNumberOfBlanksForOneSeparatorAndLeavesThoseInUnitsAlone) {
  const auto log = parse_csv_log("  t[s]   x [deg]  T[N m]\n  0     90    1\n  1     180   2\n", "run");
  EXPECT_TRUE(log.axes[0].rotary);
  EXPECT_DOUBLE_EQ(log.axes[0].x[1], std::numbers::pi);
  EXPECT_EQ(log.axes[0].force, (std::vector<double>{1.0, 2.0}));
}

TEST(ForeignTable, RefusesTwoDecimalMarksInOneTable) {
  expect_refused("t[s];x[m];F[N]\n0;1,5;2\n1;1.5;2\n", "", "run.csv:3: column 2, x[m]", "'1.5'");
  expect_refused("t[s];x[m];F[N]\n0;1.5;2\n1;1,5;2\n", "", "run.csv:3: column 2, x[m]", "'1,5'");
  expect_refused("t[s];x[m];F[N]\n0;1.234,5;2\n1;1;2\n", "", "run.csv:2: column 2, x[m]", "'1.234,5'");
}

TEST(ForeignTable, FillsBlankCellsOfAChannelThatFitsDoNotNeed) {
  const std::string text = "t[s],x[m],F[N],temperature[degC],v[m/s]\n0,1,2,,\n1,1,2,25,\n2,1,2, ,\n3,1,2,27,\n";
  const auto log = parse_csv_log(text, "run");
  EXPECT_EQ(log.axes[0].temperature, (std::vector<double>{25.0, 25.0, 26.0, 27.0}));
  ASSERT_FALSE(log.notes.empty());
  EXPECT_NE(log.notes.back().find("2 blank cells of temperature"), std::string::npos) << log.notes.back();
  // A channel without any value is none.
  EXPECT_TRUE(log.axes[0].v.empty());
  EXPECT_EQ(log.ignored, (std::vector<std::string>{"v[m/s] (blank)"}));
  EXPECT_EQ(csv_log_text(log), "t[s],x[m],F[N],temperature[degC]\n0,1,2,25\n1,1,2,25\n2,1,2,26\n3,1,2,27\n");
  expect_refused("t[s],x[m],F[N]\n0,,2\n1,,2\n", "", "run.csv:1", "no x[m] (columns with unknown names: x[m] (blank))");
}

TEST(ForeignTable, IsReadWithoutHeaderByTheColumnsStated) {
  const auto log = parse_csv_log(commas, "run");
  const std::string columns = "t[ms],x[mm],F[N]";
  const auto numbers = commas.substr(commas.find('\n') + 1);
  expect_same_log(parse_csv_log(numbers, "run", columns), log);
  for (const char separator : {';', '\t', ' '})
    expect_same_log(parse_csv_log(with_decimal_commas(numbers, separator), "run", columns), log);
  // Names of its own and a line of units are replaced.
  expect_same_log(parse_csv_log("Zeit;Weg;Kraft\nms;mm;N\n" + with_decimal_commas(numbers, ';'), "run", columns), log);
  const auto some = parse_csv_log("0,7,1,2\n1,7,1,2\n", "run", "t[ms],-,x[mm],F[N]");
  EXPECT_EQ(some.ignored, (std::vector<std::string>{"-"}));
  EXPECT_EQ(some.axes.at(0).x, (std::vector<double>{1e-3, 1e-3}));
}

TEST(ForeignTable, RefusesColumnsThatAreNotTheTables) {
  expect_refused("0,1,2\n1,1,2\n", "t[s],x[m],i[A],v[m/s]", "run.csv:1", "'0,1,2'; expected a row of 4 numbers");
  expect_refused("0,1,2\n1,1\n", "t[s],x[m],i[A]", "run.csv:2", "2 values");
  expect_refused("0,1,2\n1,1,2\n", "t[s],x[m],i[N]", "run.csv: --columns: column 3, i[N]", "not A");
  expect_refused("0,1,2\n1,1,2\n", "t[s],x[m],x[m]", "run.csv: --columns: column 3", "a second time");
  expect_refused("0,1,2\n1,1,2\n", "t[s],x[m],v[m/s]", "run.csv: --columns", "neither i[A]");
  expect_refused("only words\nand more\n", "t[s],x[m]", "run.csv:1", "'only words'");
}

TEST(ForeignTable, ReadsARotaryAxisInRadiansAndWritesItBack) {
  const auto log =
      parse_csv_log("t[s],C.x[deg],C.v[deg/s],C.T[N m],C.x_set[rev]\n0,180,90,2,0.5\n1,90,45,1,0.25\n", "run");
  const auto& axis = log.axes.at(0);
  EXPECT_TRUE(axis.rotary);
  EXPECT_DOUBLE_EQ(axis.x[0], std::numbers::pi);
  EXPECT_DOUBLE_EQ(axis.v[1], std::numbers::pi / 4.0);
  EXPECT_DOUBLE_EQ(axis.x_set[1], std::numbers::pi / 2.0);
  EXPECT_EQ(axis.force, (std::vector<double>{2.0, 1.0}));
  const auto text = csv_log_text(log);
  EXPECT_TRUE(text.starts_with("t[s],C.x_set[rad],C.x[rad],C.v[rad/s],C.T[N m]\n")) << text;
  const auto again = parse_csv_log(text, "again");
  expect_same_log(again, log);
  EXPECT_TRUE(again.axes[0].rotary);
}

TEST(ForeignTable, RefusesLinearAndRotaryColumnsOfOneAxis) {
  expect_refused("t[s],x[deg],F[N]\n0,1,2\n", "", "run.csv:1",
                 "found x[deg] of a rotary axis together with F[N] of a linear one");
  expect_refused("t[s],x[mm],v[deg/s],i[A]\n0,1,2,3\n", "", "run.csv:1",
                 "found v[deg/s] of a rotary axis together with x[mm]");
  expect_refused("t[s],x[mm],T[N m]\n0,1,2\n", "", "run.csv:1", "found T[N m] of a rotary axis together with x[mm]");
  // Axes of two kinds in one log are none of this.
  const auto log = parse_csv_log("t[s],X.x[mm],X.F[N],C.x[deg],C.T[N m]\n0,1,2,3,4\n1,1,2,3,4\n", "run");
  EXPECT_FALSE(log.axes.at(0).rotary);
  EXPECT_TRUE(log.axes.at(1).rotary);
}

TEST(ForeignTable, GivesChannelsWithoutPrefixToAllAxes) {
  const auto log = parse_csv_log(
      "t[s],supply[V],temperature[degC],X.x[m],X.i[A],Y.x[m],Y.i[A],Y.temperature[degC]\n"
      "0,600,20,1,2,3,4,30\n1,590,21,1,2,3,4,31\n",
      "run");
  ASSERT_EQ(log.axes.size(), 2u);
  EXPECT_EQ(log.axes[0].supply, (std::vector<double>{600.0, 590.0}));
  EXPECT_EQ(log.axes[1].supply, log.axes[0].supply);
  EXPECT_EQ(log.axes[0].temperature, (std::vector<double>{20.0, 21.0}));
  EXPECT_EQ(log.axes[1].temperature, (std::vector<double>{30.0, 31.0}));  // its own
}

TEST(ForeignTable, ReadsWholeNumbersOfTableAndFault) {
  const auto log = parse_csv_log("t[s],x[m],F[N],table,fault[1],master[deg]\n0,1,2,3,0,180\n1,1,2,3,7,90\n", "run");
  EXPECT_EQ(log.axes[0].table, (std::vector<double>{3.0, 3.0}));
  EXPECT_EQ(log.axes[0].fault, (std::vector<double>{0.0, 7.0}));
  EXPECT_FALSE(log.axes[0].rotary);  // the master may be of the other kind
  EXPECT_DOUBLE_EQ(log.axes[0].master[0], std::numbers::pi);
  expect_refused("t[s],x[m],F[N],table\n0,1,2,1.5\n", "", "run.csv:2: column 4, table",
                 "'1.5'; expected a whole number");
}

void write_gzip(const std::filesystem::path& file, const std::string& text) {
  const auto out = gzopen(file.c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
}

TEST(ForeignTable, IsReadCompressed) {
  const auto log = test::synthetic_log(20000);
  const auto text = csv_log_text(log);
  ASSERT_GT(text.size(), std::size_t{2} << 20);  // several blocks
  const TemporaryFile plain(".csv"), packed(".csv.gz");
  write_text_file(plain.path(), text);
  write_gzip(packed.path(), text);
  std::size_t told = 0;
  expect_same_log(read_log(packed.path(), {"", [&](std::size_t bytes) { told += bytes; }}), log);
  EXPECT_EQ(told, std::filesystem::file_size(packed.path()));
  expect_same_log(read_log(plain.path()), log);
  // Half of it is damage, not a shorter record.
  const auto bytes = read_text_file(packed.path());
  write_text_file(packed.path(), bytes.substr(0, bytes.size() / 2));
  try {
    read_log(packed.path());
    ADD_FAILURE() << "half an archive was read";
  } catch (const LogError& error) {
    EXPECT_NE(std::string(error.what()).find("found a damaged gzip archive"), std::string::npos) << error.what();
  }
}

// Blocks end anywhere: within a quoted line break, a number, CRLF.
TEST(ForeignTable, ReadsRowsAcrossTheBlocksOfAFile) {
  std::string text = "t[s],x[m],F[N],note\r\n";
  const std::size_t rows = 60000;
  for (std::size_t k = 0; k < rows; ++k) text += fmt::format("{},{}.5,2,\"line one\r\nline, {}\"\r\n", k, k, k);
  const auto log = parse_csv_log(text, "run");
  ASSERT_EQ(log.t.size(), rows);
  EXPECT_EQ(log.axes[0].x.back(), static_cast<double>(rows - 1) + 0.5);
  text += "60000,1\r\n";
  expect_refused(text, "", fmt::format("run.csv:{}", 2 + 2 * rows), "2 values");
}

TEST(ForeignTable, RefusesBytesThatAreNoRows) {
  expect_refused("t[s],x[m],F[N]\n0,1,\"" + std::string(TextSource::longest_row + 10, 'x') + "\n", "", "run.csv",
                 "a row of more than 16 MiB");
  std::string cut = utf16(commas, false);
  cut.pop_back();
  expect_refused(cut, "", "run.csv", "begins as UTF-16 and is none");
}

}  // namespace
}  // namespace stiction::host
