#include "host/log/csv_log.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "tests/host/log/synthetic_log.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

Log parse(const std::string& text) { return parse_csv_log(text, "run.csv"); }

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const LogError& error) {
    return error.what();
  }
  return "";
}

// The refusal must begin with its place and say what was found and expected.
void expect_refused(const std::string& text, const std::string& place, const std::string& found) {
  const auto message = refusal(text);
  EXPECT_TRUE(message.starts_with(place + ": ")) << message;
  EXPECT_NE(message.find(found), std::string::npos) << message;
  EXPECT_NE(message.find("; expected "), std::string::npos) << message;
}

const std::string header = "t[s],x[m],i[A]\n";
const std::string plain = header + "0,1,2\n0.001,1.5,2.5\n0.002,1.75,-2.5\n";

TEST(CsvLog, ReadsTimeAndChannels) {
  const auto log = parse(plain);
  EXPECT_EQ(log.source, "run.csv");
  ASSERT_EQ(log.axes.size(), 1u);
  EXPECT_EQ(log.axes[0].axis, "");
  EXPECT_EQ(log.t, (std::vector<double>{0.0, 0.001, 0.002}));
  EXPECT_DOUBLE_EQ(log.period, 0.001);
  EXPECT_EQ(log.axes[0].x, (std::vector<double>{1.0, 1.5, 1.75}));
  EXPECT_EQ(log.axes[0].i, (std::vector<double>{2.0, 2.5, -2.5}));
  EXPECT_TRUE(log.axes[0].x_set.empty());
  EXPECT_TRUE(log.ignored.empty());
}

TEST(CsvLog, ConvertsTheUnitsOfItsHeaderToSi) {
  const auto log =
      parse("t[ms],x[mm],i[mA],temperature[K],v_set[m/min]\n0,62.5,1500,293.15,60\n1,62.7,1600,293.15,30\n");
  EXPECT_EQ(log.t[1], 1e-3);
  EXPECT_EQ(log.axes[0].x[0], 62.5e-3);  // to the bit
  EXPECT_EQ(log.axes[0].i[0], 1.5);
  EXPECT_NEAR(log.axes[0].temperature[0], 20.0, 1e-12);
  EXPECT_DOUBLE_EQ(log.axes[0].v_set[0], 1.0);
}

TEST(CsvLog, ReadsEveryChannelOfTheContract) {
  const auto log = parse(
      "t[s],x_set[m],v_set[m/s],a_set[m/s^2],x[m],v[m/s],i[A],i_set[A],F[N],u[V],temperature[degC],F_ext[N],"
      "i_inject[A],u_inject[V],x_load[m],supply[V],T_motor[N m],master[rad],master_speed[rad/s],table,fault\n"
      "0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20\n1,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20\n");
  double expected = 0.0;
  for (const auto& channel : log_channels) EXPECT_EQ((log.axes[0].*channel.values).at(0), expected += 1.0);
}

TEST(CsvLog, KeepsComments) {
  const auto log = parse("# machine: cross table\n# feed:8 m/min\r\n# a note\n" + plain);
  using Pair = std::pair<std::string, std::string>;
  EXPECT_EQ(log.comments, (std::vector<Pair>{{"machine", "cross table"}, {"feed", "8 m/min"}, {"a note", ""}}));
}

TEST(CsvLog, SplitsTwoAxes) {
  const auto log = parse("t[s],X.x[m],X.i[A],Y.x[m],Y.F[N]\n0,1,2,3,4\n1,1,2,3,4\n");
  ASSERT_EQ(log.axes.size(), 2u);
  EXPECT_EQ(log.axes[0].axis, "X");
  EXPECT_EQ(log.axes[1].axis, "Y");
  EXPECT_EQ(log.axes[1].x[0], 3.0);
  EXPECT_EQ(log.axes[1].force[0], 4.0);
}

TEST(CsvLog, ListsUnknownColumnsAndLeavesTheirValuesAlone) {
  const auto log = parse("t[s],x[m],i[A],X.e[m],note,\n0,1,2,,text,\n1,1,2,nan,\"a, b\",\n");
  EXPECT_EQ(log.ignored, (std::vector<std::string>{"X.e[m]", "note", ""}));
  EXPECT_EQ(log.axes.size(), 1u);
}

TEST(CsvLog, ReadsQuotedFieldsAndLineEndsOfRfc4180) {
  const auto log = parse("\"t[s]\",\"x[m]\",\"i[A]\",\"say \"\"so\"\"\"\r\n\"0\",1,\"2\",\"two\nlines\"\r\n1,1,2,\r\n");
  EXPECT_EQ(log.t.size(), 2u);
  EXPECT_EQ(log.axes[0].i[0], 2.0);
  EXPECT_EQ(log.ignored, (std::vector<std::string>{"say \"so\""}));
}

TEST(CsvLog, ReadsAByteOrderMarkBlanksPlusSignsAndEmptyLinesAtTheEnd) {
  const auto log = parse("\xEF\xBB\xBF# a: b\n t[s] , x [m], i[A] \n0, +1 ,2\n1,1e0,2\n\n \n");
  EXPECT_EQ(log.t.size(), 2u);
  EXPECT_EQ(log.axes[0].x[0], 1.0);
}

TEST(CsvLog, NeedsNoLineEndBehindTheLastRow) { EXPECT_EQ(parse(header + "0,1,2\n1,1,2").t.size(), 2u); }

TEST(CsvLog, RefusesABadValueWithFileLineAndColumn) {
  expect_refused(header + "0,1,2\n1,nan,2\n", "run.csv:3: column 2, x[m]", "'nan'");
  expect_refused(header + "0,1,2\n1,1,inf\n", "run.csv:3: column 3, i[A]", "'inf'");
  expect_refused(header + "0,1,2\n,1,2\n", "run.csv:3: column 1, t[s]", "nothing");
  expect_refused(header + "0,1,2\n1,1 m,2\n", "run.csv:3: column 2, x[m]", "'1 m'");
  expect_refused(header + "0,1,2\n1,1e999,2\n", "run.csv:3: column 2, x[m]", "'1e999'");
  expect_refused("t[s],x[km],i[A]\n0,1,2\n1,1e308,2\n", "run.csv:3: column 2, x[km]", "'1e308'");
  expect_refused(header + "0,1,2\n1,\"0,5\",2\n", "run.csv:3: column 2, x[m]", "'0,5'");
  expect_refused(header + "0,1,2\n1,0x1p3,2\n", "run.csv:3: column 2, x[m]", "'0x1p3'");
}

TEST(CsvLog, CountsLinesThroughCommentsAndQuotedLineBreaks) {
  expect_refused("# a: b\nt[s],x[m],i[A],note\n0,1,2,\"one\ntwo\"\n1,nan,2,\n", "run.csv:5: column 2, x[m]", "'nan'");
}

TEST(CsvLog, RefusesRaggedRows) {
  expect_refused(header + "0,1,2\n1,1\n", "run.csv:3", "2 values");
  expect_refused(header + "0,1,2\n1,1,2,3\n", "run.csv:3", "4 values");
  expect_refused(header + "0,1,2\n\n1,1,2\n", "run.csv:3", "an empty line");
  expect_refused(header + "0,1,2\n1,1,2,", "run.csv:3", "4 values");
}

TEST(CsvLog, RefusesTimeThatDoesNotRiseUniformly) {
  expect_refused(header + "0,1,2\n1,1,2\n1,1,2\n", "run.csv:4: column 1, t[s]", "'1'");
  expect_refused(header + "0,1,2\n1,1,2\n0.5,1,2\n", "run.csv:4: column 1, t[s]", "'0.5'");
  expect_refused(header + "0,1,2\n0.001,1,2\n0.002,1,2\n0.005,1,2\n0.006,1,2\n", "run.csv:5",
                 "a gap of 3 ms before this sample, where 2 samples are missing");
  expect_refused(header + "0.000,1,2\n0.001,1,2\n0.0023,1,2\n0.003,1,2\n0.004,1,2\n", "run.csv:4", "a step of 1.3 ms");
}

// From 1 ms to 1.008 ms: no step tells, the sum of them does.
TEST(CsvLog, ResamplesARateThatDriftsWithinTheToleranceOfAStep) {
  std::string text = header;
  for (int k = 0; k < 2000; ++k) text += fmt::format("{:.9f},0,0\n", k < 1000 ? k * 1e-3 : 1.0 + (k - 1000) * 1.008e-3);
  const auto log = parse(text);
  EXPECT_TRUE(log.clock.resampled);
  EXPECT_EQ(log.clock.stretches, 1u);
  EXPECT_LT(log.clock.jitter, 1e-6);
}

// Six significant digits, as %g and many exporters write: from 10 s on a stamp at 16 kHz is off by up to 50 us.
TEST(CsvLog, AcceptsStampsRoundedToTheDigitsWritten) {
  std::string fixed = header, general = header;
  for (int k = 0; k < 20000; ++k) {
    fixed += fmt::format("{:.4f},0,0\n", k * 250e-6);
    general += fmt::format("{:.6g},0,0\n", k * 1e-3);
  }
  EXPECT_NEAR(parse(fixed).period, 250e-6, 1e-4 / 19999);  // both ends are off by up to half of 1e-4 s
  EXPECT_NEAR(parse(general).period, 1e-3, 1e-9);
}

TEST(CsvLog, FindsAGapInStampsRoundedToTheDigitsWritten) {
  std::string text = header;
  for (int k = 0; k < 20000; ++k)
    if (k != 15000) text += fmt::format("{:.6g},0,0\n", k * 1e-3);
  const auto log = parse(text);
  EXPECT_EQ(log.source, "run.csv, segment 1 of 2");
  EXPECT_EQ(log.t.size(), 15000u);
  ASSERT_EQ(log.others.size(), 1u);
  EXPECT_EQ(log.others[0].t.size(), 4999u);
}

TEST(CsvLog, AcceptsStampsThatAreWholeSteps) {
  EXPECT_DOUBLE_EQ(parse(header + "0.0,1,2\n0.1,1,2\n0.2,1,2\n0.3,1,2\n").period, 0.1);
  expect_refused(header + "0.0,1,2\n0.1,1,2\n0.2,1,2\n0.4,1,2\n", "run.csv:5", "1 sample is missing");
}

TEST(CsvLog, RefusesMissingChannelsByName) {
  expect_refused("x[m],i[A]\n1,2\n", "run.csv:1", "no column t[s]");
  expect_refused("t[s],i[A]\n0,2\n1,2\n", "run.csv:1", "no x[m]");
  expect_refused("# a: b\nt[s],x[m]\n0,2\n1,2\n", "run.csv:2", "neither i[A] nor F[N] nor u[V]");
  expect_refused("t[s],X.x[m],X.i[A],Y.x[m]\n0,2,1,1\n1,2,1,1\n", "run.csv:1", "neither Y.i[A]");
  expect_refused("t[s],pos[m],cur[A]\n0,2,1\n1,2,1\n", "run.csv:1", "columns with unknown names: pos[m], cur[A]");
  expect_refused("t[s],x[m],i[A],Y.x[m],Y.i[A]\n0,2,1,1,1\n1,2,1,1,1\n", "run.csv:1",
                 "together with channels without one");
}

TEST(CsvLog, RefusesWrongMissingAndRepeatedHeaders) {
  expect_refused("t[s],x[N],i[A]\n0,1,2\n", "run.csv:1: column 2, x[N]", "dimension m kg s^-2, not m");
  expect_refused("t[s],x[furlongs per],i[A]\n0,1,2\n", "run.csv:1: column 2, x[furlongs per]", "unknown unit");
  expect_refused("t[s],x,i[A]\n0,1,2\n", "run.csv:1: column 2, x", "no unit");
  expect_refused("t[m],x[m],i[A]\n0,1,2\n", "run.csv:1: column 1, t[m]", "dimension m, not s");
  expect_refused("t[s],x[m],i[A],x[mm]\n0,1,2,3\n", "run.csv:1: column 4", "x a second time");
  expect_refused("t[s],X.x[m],i[A],X.x[mm]\n0,1,2,3\n", "run.csv:1: column 4", "X.x a second time");
}

TEST(CsvLog, RefusesWhatIsNoTable) {
  expect_refused("", "run.csv:1", "no header");
  expect_refused("# a: b\n\n", "run.csv:1", "no header");
  expect_refused(header, "run.csv:1", "0 samples");
  expect_refused(header + "0,1,2\n", "run.csv:2", "1 sample;");
  expect_refused("t[s],\"x[m],i[A]\n0,1,2\n", "run.csv:1", "never closed");
  expect_refused("t[s],\"x\"[m],i[A]\n0,1,2\n", "run.csv:1", "behind a closing quote");
  const auto message = refusal("t[s],x[\x01" + std::string(200, 'm') + "],i[A]\n0,1,2\n");
  EXPECT_EQ(message.find('\x01'), std::string::npos);
  EXPECT_LT(message.size(), 400u);
}

TEST(CsvLog, NamesAFileThatCannotBeRead) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      read_csv_log(file);
    } catch (const LogError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(
      message("/nowhere/run.csv").starts_with("/nowhere/run.csv: found no folder /nowhere; expected a log in it"));
  EXPECT_TRUE(message(std::filesystem::temp_directory_path()).find("found a folder") != std::string::npos);
}

TEST(CsvLog, WritesWhatItReadsToTheBit) {
  const auto log = test::synthetic_log(1000);
  expect_same_log(parse_csv_log(csv_log_text(log), "again"), log);
}

TEST(CsvLog, WritesCommentsOnOneLine) {
  auto log = parse(plain);
  log.comments = {{"note", "two\nlines"}, {"alone", ""}};
  EXPECT_TRUE(csv_log_text(log).starts_with("# note: two lines\n# alone\nt[s],x[m],i[A]\n"));
}

// 25 000 samples of ten channels: the wall time is printed, not judged.
TEST(CsvLog, ReadsALongLog) {
  const auto text = csv_log_text(test::synthetic_log(25000));
  const auto start = std::chrono::steady_clock::now();
  const auto log = parse_csv_log(text, "long");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(log.t.size(), 25000u);
  test::figure("read a CSV log of 25000 x 10 values", fmt::format("{:.0f} ms", took.count() * 1e3));
}

TEST(CsvLog, ReadsTheMeasuredPositioningSystem) {
  const auto file = std::filesystem::path(STICTION_SOURCE_DIR) / ".." / "shared" / "data" / "emps.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const auto log = read_csv_log(file);
  EXPECT_EQ(log.t.size(), 24841u);
  EXPECT_NEAR(log.period, 1e-3, 1e-12);
  EXPECT_EQ(log.axes[0].u.size(), 24841u);
}

}  // namespace
}  // namespace stiction::host
