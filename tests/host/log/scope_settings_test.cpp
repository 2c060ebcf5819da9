// One recording of the TwinCAT Scope exported with different settings: the channels and values are the same. The real
// exports lie outside of the repository (shared/data/twincat); those written here have their shape.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "host/log/mapping.hpp"
#include "host/log/read_log.hpp"
#include "host/log/text_file.hpp"
#include "host/log/text_source.hpp"
#include "tests/host/log/temporary_file.hpp"

namespace stiction::host {
namespace {

const std::filesystem::path real = std::filesystem::path(STICTION_SOURCE_DIR) / ".." / "shared" / "data" / "twincat";

using Channels = std::map<std::string, RecordedChannel>;

Channels by_name(const Recording& recording) {
  Channels channels;
  for (const auto& channel : recording.channels) channels[channel.name] = channel;
  EXPECT_EQ(channels.size(), recording.channels.size()) << "names repeat";
  return channels;
}

// Equal to the bit: the same decimals were written. `scaled`: the values of `channels` have the head's factors already.
void expect_same_channels(const Channels& channels, const Channels& expected, bool scaled) {
  ASSERT_EQ(channels.size(), expected.size());
  for (const auto& [name, wanted] : expected) {
    ASSERT_TRUE(channels.contains(name)) << name;
    const auto& channel = channels.at(name);
    EXPECT_EQ(channel.bad, "") << name;
    EXPECT_EQ(channel.unit, wanted.unit) << name;
    EXPECT_EQ(channel.scaling, wanted.scaling) << name;
    EXPECT_EQ(channel.t, wanted.t) << name;
    auto values = wanted.values;
    if (wanted.scaling && scaled)
      for (double& value : values) value = (*wanted.scaling)(value);
    EXPECT_EQ(channel.values, values) << name;
  }
}

// "Name" and what follows it: groups with a time of their own, a comment without value, scale factors, a channel that
// ends early in a group of its own at the end.
std::string shaped(char separator, char decimal, const std::string& line_end, bool line_ends_with_separator) {
  std::string text =
      "Name|run|\nStarttime of export|132959733843760000|Montag, 2. Mai 2022|15:56:24.376\n\n"
      "Name|fast|Name|one|two words|three|two words (1)|Name|slow|\n"
      "SymbolComment||SymbolComment|||||SymbolComment||\n"
      "Data-Type|REAL32|Data-Type|BIT|REAL32|REAL32|REAL32|Data-Type|REAL32|\n"
      "SampleTime[ms]|0,5|SampleTime[ms]|1|1|1|1|SampleTime[ms]|2|\n"
      "SymbolName|M.f|SymbolName|M.o|M.w|M.t|M.w|SymbolName|M.s|\n"
      "Offset|0|Offset|0|0|0|0|Offset|0|\n"
      "Unit|(None)|Unit|(None)|mm (Length)|(None)|dV (Voltage)|Unit|(None)|\n"
      "Unit ScaleFactor|1|Unit ScaleFactor|1|1|1|-10|Unit ScaleFactor|1|\n"
      "Unit Offset|0|Unit Offset|0|0|0|10|Unit Offset|0|\n\n"
      "0|1.5|0|1|2.5|3|4|-3|7\n0.5|1.6|1|0|2.6|3|4|-1|8\n1|1.7|2|1|2.7|3|4\n1.5|1.8\n";
  std::string out;
  bool data = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '\n' && k + 1 < text.size() && text[k + 1] == '0') data = true;
    if (c == '|' && text[k + 1] == '\n' && !line_ends_with_separator) continue;
    if (c == '|')
      out += separator;
    else if (c == '\n')
      out += line_end;
    else
      out += data && c == '.' ? decimal : c;
  }
  // As the Scope does with blanks: the keys of the file's own head are quoted, those of the channels not.
  if (separator == ' ')
    for (const std::string key : {"Starttime of export", "Montag, 2. Mai 2022"})
      out.replace(out.find(key), key.size(), "\"" + key + "\"");
  return out;
}

TEST(ScopeSettings, EverySeparatorDecimalMarkAndLineEndGivesTheSameChannels) {
  const auto expected = by_name(read_scope_export(shaped('\t', '.', "\n", false), "run.csv"));
  ASSERT_EQ(expected.size(), 6u);
  EXPECT_EQ(expected.at("fast").t, (std::vector<double>{0.0, 0.5e-3, 1e-3, 1.5e-3}));
  EXPECT_EQ(expected.at("two words").values, (std::vector<double>{2.5, 2.6, 2.7}));
  EXPECT_EQ(expected.at("two words").unit, "mm");
  EXPECT_EQ(expected.at("two words (1)").unit, "dV");
  EXPECT_EQ((*expected.at("two words (1)").scaling)(4.0), -30.0);
  EXPECT_EQ(expected.at("slow").t, (std::vector<double>{-3e-3, -1e-3}));
  for (const char separator : {'\t', ' ', ':', ';', ','})
    for (const std::string line_end : {"\n", "\r\n"})
      for (const bool ends : {false, true}) {
        // With commas the sample time's decimal comma moves its row's columns, and a decimal comma cannot be.
        const bool blank_ends = separator == ' ' && ends;
        if (blank_ends) continue;
        for (const char decimal : {'.', ','}) {
          if (decimal == separator) continue;
          const auto text = shaped(separator, decimal, line_end, ends);
          ASSERT_TRUE(is_scope_export(text)) << text;
          SCOPED_TRACE(text);
          expect_same_channels(by_name(read_scope_export(text, "run.csv")), expected, false);
        }
      }
}

// As a spreadsheet writes "Unicode text": every character of the export in two bytes, behind a byte-order mark.
TEST(ScopeSettings, Utf16GivesTheSameChannels) {
  const auto text = shaped('\t', ',', "\r\n", false);
  const auto expected = by_name(read_scope_export(text, "run.csv"));
  for (const bool little : {true, false}) {
    std::string wide = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char c : text) wide += little ? std::string{c, '\0'} : std::string{'\0', c};
    const test::TemporaryFile scope(".csv");
    write_text_file(scope.path(), wide);
    EXPECT_TRUE(is_scope_export(first_bytes(scope.path(), 101)));  // the last character is cut in two
    expect_same_channels(by_name(read_recording(scope.path(), {})), expected, false);
    write_text_file(scope.path(), wide + "\n");
    EXPECT_THROW(read_recording(scope.path(), {}), LogError);
  }
}

// Blanks within names are blanks between names: where the file does not show which, columns are named by number.
TEST(ScopeSettings, NamesColumnsByNumberWhereBlanksLeaveTheNamesOpen) {
  auto text = shaped(' ', '.', "\n", false);
  const std::string name = "two words (1)";
  text.replace(text.find(name), name.size(), "two more");
  const auto channels = by_name(read_scope_export(text, "run.csv"));
  EXPECT_TRUE(channels.contains("fast"));
  ASSERT_TRUE(channels.contains("column 5"));
  EXPECT_EQ(channels.at("column 5").values, (std::vector<double>{2.5, 2.6, 2.7}));
}

TEST(ScopeSettings, AsksWhetherTheScaleFactorsOfTheHeadAreApplied) {
  const test::TemporaryFile scope(".csv"), map(".toml");
  write_text_file(scope.path(), shaped('\t', '.', "\n", false));
  const auto log = [&](const std::string& scaling) {
    write_text_file(map.path(),
                    "schema = \"stiction.mapping/1\"\n[[channel]]\nfrom = \"two words\"\nto = \"x\"\n"
                    "[[channel]]\nfrom = \"two words (1)\"\nto = \"u\"\nunit = \"V\"\n" +
                        scaling);
    const auto mapping = read_mapping(map.path());
    return apply_mapping(mapping, read_recording(scope.path(), mapping.table));
  };
  EXPECT_EQ(log("scaling = \"done\"\n").axes[0].u.at(0), 4.0);
  EXPECT_EQ(log("scaling = \"apply\"\n").axes[0].u.at(0), -30.0);
  try {
    log("");
    ADD_FAILURE() << "scale factors of unknown use were passed over";
  } catch (const LogError& error) {
    const std::string message = error.what();
    EXPECT_NE(
        message.find(":5: 'two words (1)': found ScaleFactor 1, Offset 0, Unit ScaleFactor -10 and Unit Offset 10"),
        std::string::npos)
        << message;
    EXPECT_NE(message.find("expected scaling = \"done\" or scaling = \"apply\""), std::string::npos) << message;
  }
}

TEST(ScopeSettings, ChannelsThatBeginLaterOrEndEarlierAreBlankThere) {
  const test::TemporaryFile scope(".csv"), map(".toml");
  write_text_file(scope.path(),
                  "Name\trun\nStartRecord\t1\n\nName\tx\tName\ti\tName\tu\nSampleTime[ms]\t1\tSampleTime[ms]\t1\t"
                  "SampleTime[ms]\t1\nUnit\tmm\tUnit\tA\tUnit\tV\n\n"
                  "0\t1\t1\t5\t-1\t7\n1\t2\t2\t6\t0\t8\n2\t3\t \t \t1\t9\n3\t4\t \t \t2\t10\n");
  // Its channels have the names of a log's: no mapping is needed.
  const auto log = read_log(scope.path());
  // What all that a fit needs have in common: the current has no value in the first and in the last sample of x.
  EXPECT_EQ(log.t, (std::vector<double>{1e-3, 2e-3}));
  const auto& axis = log.axes.at(0);
  EXPECT_EQ(axis.x, (std::vector<double>{2e-3, 3e-3}));
  EXPECT_EQ(axis.i, (std::vector<double>{5.0, 6.0}));
  EXPECT_EQ(axis.u, (std::vector<double>{9.0, 10.0}));
}

// The real recording: 21 channels of four sample times and starts. The default export has unscaled values, the others
// scaled ones; the scale factors stand in the head of all.
TEST(ScopeSettings, RealExportsOfEverySettingHaveTheSamplesOfTheDefaultOne) {
  const auto name = [](const char* setting) { return real / fmt::format("tc3_scope_3_4_3145_3-{}", setting); };
  if (!std::filesystem::exists(name("default.csv"))) GTEST_SKIP() << real << " is not here";
  const auto expected = by_name(read_recording(name("default.csv"), {}));
  ASSERT_EQ(expected.size(), 21u);
  EXPECT_EQ(expected.at("func_OS").t.size(), 4996u);
  EXPECT_EQ(expected.at("var_REAL64").t.size(), 1000u);
  EXPECT_EQ(expected.at("func_freesample").t.size(), 201u);
  EXPECT_DOUBLE_EQ(expected.at("func_freesample").t.front(), -3e-3);
  EXPECT_EQ(expected.at("func_units_scaled").unit, "dV");
  EXPECT_EQ(expected.at("var_INT8").values.at(130), -126.0);
  expect_same_channels(by_name(read_recording(name("default.csv.gz"), {})), expected, false);
  for (const auto* setting : {"DecimalMark_,.csv", "ExcludeDoubleTimestamp_false-SortChannels_true.csv",
                              "Seperator_1.csv", "Seperator_3.csv"}) {
    SCOPED_TRACE(setting);
    expect_same_channels(by_name(read_recording(name(setting), {})), expected, true);
  }
}

}  // namespace
}  // namespace stiction::host
