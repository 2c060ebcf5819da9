#include "host/log/recording.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <cmath>

#include "firmware/machine/file/machine_file.hpp"
#include "host/log/mapping.hpp"
#include "host/log/text_file.hpp"
#include "tests/host/log/temporary_file.hpp"

namespace stiction::host {
namespace {

using test::TemporaryFile;

// As the Scope of a machine with German settings writes it: every channel with its own time.
const std::string own_times =
    "\xEF\xBB\xBF"
    "Name\tYT Scope Project\r\n"
    "StartRecord\t133456789000000000\tMontag\r\n"
    "EndRecord\t133456789000030000\tMontag\r\n"
    "\r\n"
    "Name\tActPos\tName\tActCurrent\r\n"
    "NetId\t5.35.1.1.1.1\tNetId\t5.35.1.1.1.1\r\n"
    "Port\t501\tPort\t501\r\n"
    "SampleTime[ms]\t1\tSampleTime[ms]\t1\r\n"
    "SymbolName\tAxes.X.ActPos\tSymbolName\tAxes.X.ActCurrent\r\n"
    "Data-Type\tREAL64\tData-Type\tREAL64\r\n"
    "VariableSize\t8\tVariableSize\t8\r\n"
    "Unit\tmm\tUnit\t(None)\r\n"
    "\r\n"
    "0\t1,5\t0\t-2,25\r\n"
    "1\t1,75\t1\t2\r\n"
    "2\t2\t2\t1e-1\r\n"
    "EOF\r\n";

// One time for all, FILETIME, decimal points; the temperature only every second sample.
const std::string shared_time =
    "Name\tProject\n"
    "StartRecord\t133456789000000000\n"
    "\n"
    "Name\tPos\tCurrent\tTemperature\n"
    "SampleTime[ms]\t1\t1\t2\n"
    "\n"
    "133456789000000000\t1.5\t3\t25\n"
    "133456789000010000\t1.6\t4\t\n"
    "133456789000020000\t1.7\t5\t26\n"
    "133456789000030000\t1.8\t5\t\n";

const std::string table =
    "# exported by a recorder\n"
    "Zeit (ms);Weg (mm);Strom;Status\n"
    "0,0;1,5;2,0;ok\n"
    "0,5;1,6;2,1;ok\n"
    "1,0;1,7;2,2;ok\n";

const std::string json =
    R"({"Header": {"CycleTimeMs": 2, "SignalListHFData": [
         {"Name": "DES_POS|1", "Type": "DOUBLE", "Axis": "X1", "Address": "DES_POS|1"},
         {"Name": "CYCLE", "Type": "INTEGER", "Axis": "Cycle", "Address": "CYCLE"},
         {"Name": "ENC_POS|1", "Type": "DOUBLE", "Axis": "X1", "Address": "ENC_POS|1"},
         {"Name": "CURRENT|1", "Type": "DOUBLE", "Axis": "X1", "Address": "CURRENT|1"}]},
        "Payload": [{"HFTimestamp": {}}, {"HFData": [[1.0, 5000, 1.01, 2], [1.1, 5001, 1.11, 2.5]]},
                    {"HFData": [[1.2, 5002, 1.21, -3]]}],
        "Footer": {}})";

std::string zipped(const std::string& content, const char* entry = "job.json") {
  const TemporaryFile file(".zip");
  zip_t* archive = zip_open(file.path().c_str(), ZIP_CREATE, nullptr);
  zip_file_add(archive, entry, zip_source_buffer(archive, content.data(), content.size(), 0), 0);
  zip_close(archive);
  return read_text_file(file.path());
}

constexpr const char* scope_map = R"(schema = "stiction.mapping/1"
[[channel]]
from = "ActPos"
to = "X.x"
[[channel]]
from = "ActCurrent"
to = "X.i"
unit = "A"
amperes = "rms"
reverse = true
)";

Log mapped(const std::string& recording, const std::string& mapping_text) {
  const TemporaryFile map(".toml"), in(".csv");
  write_text_file(map.path(), mapping_text);
  write_text_file(in.path(), recording);
  const auto mapping = read_mapping(map.path());
  return apply_mapping(mapping, read_recording(in.path(), mapping.table));
}

std::string refusal(const std::string& recording, const std::string& mapping_text) {
  try {
    mapped(recording, mapping_text);
  } catch (const LogError& error) {
    return error.what();
  } catch (const machine::MachineFileError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ScopeExport, IsReadWithATimeForEachChannelAndDecimalCommas) {
  const auto log = mapped(own_times, scope_map);
  EXPECT_EQ(log.t, (std::vector<double>{0.0, 1e-3, 2e-3}));
  ASSERT_EQ(log.axes.size(), 1u);
  EXPECT_EQ(log.axes[0].axis, "X");
  EXPECT_EQ(log.axes[0].x, (std::vector<double>{1.5e-3, 1.75e-3, 2e-3}));  // mm, from the Unit row
  EXPECT_DOUBLE_EQ(log.axes[0].i[0], 2.25 * std::sqrt(2.0));               // rms, counted the other way
  EXPECT_EQ(log.comments[0], (std::pair<std::string, std::string>{"StartRecord", "133456789000000000"}));
}

TEST(ScopeExport, IsReadWithOneFiletimeForAllAndASlowerChannel) {
  const std::string map =
      "schema = \"stiction.mapping/1\"\n"
      "[[channel]]\nfrom = \"Pos\"\nto = \"x\"\nunit = \"mm\"\n"
      "[[channel]]\nfrom = \"Current\"\nto = \"i\"\nunit = \"A\"\namperes = \"peak\"\n"
      "[[channel]]\nfrom = \"Temperature\"\nto = \"temperature\"\nunit = \"degC\"\nfill = \"linear\"\n";
  const auto log = mapped(shared_time, map);
  EXPECT_DOUBLE_EQ(log.period, 1e-3);
  EXPECT_EQ(log.axes[0].i, (std::vector<double>{3.0, 4.0, 5.0, 5.0}));
  EXPECT_DOUBLE_EQ(log.axes[0].temperature[1], 25.5);
  EXPECT_DOUBLE_EQ(log.axes[0].temperature[3], 26.0);
  const auto held = mapped(shared_time, replaced(map, "linear", "hold"));
  EXPECT_EQ(held.axes[0].temperature[1], 25.0);
  const auto message = refusal(shared_time, replaced(map, "fill = \"linear\"\n", ""));
  EXPECT_NE(message.find("found 2 samples at other times than the 4"), std::string::npos) << message;
}

// Slower groups are filled up with their last row.
TEST(ScopeExport, PassesOverRepeatedStamps) {
  auto text = replaced(own_times, "2\t2\t2\t1e-1\r\n", "1\t1,75\t2\t1e-1\r\n");
  const auto log = mapped(text, scope_map);  // to the end of the position
  EXPECT_EQ(log.t, (std::vector<double>{0.0, 1e-3}));
  EXPECT_EQ(log.axes[0].x, (std::vector<double>{1.5e-3, 1.75e-3}));
  EXPECT_EQ(log.axes[0].i.size(), 2u);
}

TEST(PlainTable, IsReadByItsMapping) {
  const auto log = mapped(table,
                          "schema = \"stiction.mapping/1\"\n[time]\ncolumn = \"Zeit\"\n"
                          "[[channel]]\nfrom = \"Weg\"\nto = \"x\"\n"
                          "[[channel]]\nfrom = \"Strom\"\nto = \"i\"\nunit = \"A\"\namperes = \"peak\"\n");
  EXPECT_DOUBLE_EQ(log.period, 0.5e-3);
  EXPECT_DOUBLE_EQ(log.axes[0].x[2], 1.7e-3);
  EXPECT_EQ(log.ignored, (std::vector<std::string>{"Status"}));
}

TEST(PlainTable, IsReadWithAPeriodAndALineForItsHeader) {
  const auto log = mapped("Recorder 3000\nunits: mm\npos\tforce\n1.5\t2\n1.6\t3\n",
                          "schema = \"stiction.mapping/1\"\n[time]\nperiod = \"62.5 us\"\n[table]\nheader_line = 3\n"
                          "separator = \"tab\"\ndecimal = \".\"\n"
                          "[[channel]]\nfrom = \"pos\"\nto = \"x\"\nunit = \"mm\"\n"
                          "[[channel]]\nfrom = \"force\"\nto = \"F\"\nunit = \"kN\"\n");
  EXPECT_DOUBLE_EQ(log.period, 62.5e-6);
  EXPECT_EQ(log.axes[0].force[1], 3000.0);
}

constexpr const char* recorder_map = R"(schema = "stiction.mapping/1"
[[channel]]
from = "ENC_POS|1"
to = "X.x"
unit = "mm"
[[channel]]
from = "DES_POS|1"
to = "X.x_set"
unit = "mm"
[[channel]]
from = "CURRENT|1"
to = "X.i"
unit = "A"
amperes = "peak"
)";

TEST(RecorderExport, IsReadPlainAndZipped) {
  for (const auto& bytes : {json, zipped(json)}) {
    const auto log = mapped(bytes, recorder_map);
    EXPECT_EQ(log.t, (std::vector<double>{0.0, 2e-3, 4e-3}));
    EXPECT_EQ(log.axes[0].x[0], 1.01e-3);
    EXPECT_EQ(log.axes[0].x_set[2], 1.2e-3);
    EXPECT_EQ(log.axes[0].i[2], -3.0);
  }
}

TEST(RecorderExport, IsRefusedWithWhatItLacks) {
  const auto expect = [](const std::string& bytes, const char* found) {
    const auto message = refusal(bytes, recorder_map);
    EXPECT_NE(message.find(found), std::string::npos) << message;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
  };
  expect("{", "no valid JSON");
  expect("{}", "no Header.SignalListHFData or no Payload");
  expect(replaced(json, "\"CycleTimeMs\": 2", "\"CycleTimeMs\": 0"), "no Header.CycleTimeMs");
  expect(replaced(json, "\"Address\": \"CYCLE\"", "\"Address\": \"C\"").replace(json.find("\"CYCLE\""), 7, "\"C\""),
         "no CYCLE (HFProbeCounter)");
  expect(replaced(json, "[1.1, 5001, 1.11, 2.5]", "[1.1, 5001, 1.11]"), "row 2 of HFData: found 3 values");
  expect(replaced(json, "1.11, 2.5", "\"x\", 2.5"), "row 2 of HFData, ENC_POS|1: found \"x\"");
  expect(replaced(json, "1.11, 2.5", "[[\"x\"]], 2.5"), "row 2 of HFData, ENC_POS|1: found array");
  expect(replaced(json, "1.11, 2.5", "1e999, 2.5"), "no valid JSON");  // beyond the range of double
  expect(replaced(json, "5001", "null"), "no number as CYCLE");
  expect(zipped(json, "job.txt"), "found 0 JSON files");
  expect(zipped(json).substr(0, 200), "cannot be read");
}

// A counter that jumps is a gap in the recording.
TEST(RecorderExport, FindsMissingCycles) {
  std::string rows;
  for (int k = 0; k < 20; ++k) rows += fmt::format("{}[1, {}, 1, 1]", k > 0 ? ", " : "", k < 12 ? k : k + 3);
  const auto start = json.find("[[1.0"), end = json.find("2.5]]") + 5;
  auto text = json;
  text.replace(start, end - start, "[" + rows + "]");
  text = replaced(text, ",\n                    {\"HFData\": [[1.2, 5002, 1.21, -3]]}", "");
  const auto message = refusal(text, recorder_map);
  EXPECT_NE(message.find("sample 13: found a gap of 8 ms"), std::string::npos) << message;
}

TEST(Mapping, AsksForPeakOrRmsOfEveryCurrent) {
  const auto message = refusal(own_times, replaced(scope_map, "amperes = \"rms\"\n", ""));
  EXPECT_NE(message.find("amperes: found no such key"), std::string::npos) << message;
  EXPECT_NE(message.find("amperes = \"peak\" or amperes = \"rms\""), std::string::npos) << message;
  EXPECT_NE(message.find(".toml:5"), std::string::npos) << message;
  EXPECT_NE(refusal(own_times, replaced(scope_map, "rms", "effective")).find("amperes = \"peak\""), std::string::npos);
  EXPECT_NE(
      refusal(own_times, replaced(scope_map, "\"X.x\"\n", "\"X.x\"\namperes = \"rms\"\n")).find("X.x is not a current"),
      std::string::npos);
}

TEST(Mapping, RefusesWhatItCannotApply) {
  const std::string map = scope_map;
  const auto expect = [&](const std::string& recording, const std::string& mapping, const char* found) {
    const auto message = refusal(recording, mapping);
    EXPECT_NE(message.find(found), std::string::npos) << message;
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
  };
  expect(own_times, replaced(map, "ActPos", "ActPos2"), "found no channel 'ActPos2'");
  expect(own_times, replaced(map, "X.x", "X.pos"), "to: found \"X.pos\"");
  expect(own_times, replaced(map, "unit = \"A\"\n", ""), "found no unit");
  expect(own_times, replaced(map, "unit = \"A\"", "unit = \"N\""), "found the unit 'N'");
  expect(own_times, map + "[[channel]]\nfrom = \"ActPos\"\nto = \"X.x\"\n", "\"X.x\" a second time");
  expect(own_times, replaced(map, "reverse", "revers"), "reverse");
  expect(own_times, replaced(map, "true", "1"), "reverse: found 1");
  expect(own_times, map + "fill = \"cubic\"\n", "fill: found \"cubic\"");
  expect(own_times, replaced(map, "mapping/1", "mapping/2"), "schema: found \"stiction.mapping/2\"");
  expect(own_times, "schema = \"stiction.mapping/1\"\n", "channel: found no such key");
  expect(own_times, map + "[time]\nperiod = \"1 ms\"\n", "found [table] or [time]");
  expect(own_times, map + "[time]\nperiod = \"1 m\"\n", "period: found \"1 m\"");
  expect(own_times, map + "[time]\n", "neither column nor period");
  expect(own_times, map + "[table]\nseparator = \"|\"\n", "separator: found \"|\"");
  expect(own_times, map + "[table]\nheader_line = 0\n", "header_line: found 0");
  expect(own_times, replaced(map, "X.x", "X.x_set"), "found no channel with to = \"x\"");
  expect(replaced(own_times, "\t1,75\t", "\tnan\t"), map, ":15: column 2, ActPos: found 'nan'");
  expect(replaced(own_times, "1\t1,75\t", "one\t1,75\t"), map, ":15: column 1: found 'one'");
  expect(table, "schema = \"stiction.mapping/1\"\n[time]\ncolumn = \"Time\"\n[[channel]]\nfrom = \"Weg\"\nto = \"x\"\n",
         "found no column 'Time'");
}

TEST(Mapping, HintNamesTheChannels) {
  const auto hint = mapping_hint(read_scope_export(own_times, "run.csv"));
  EXPECT_TRUE(hint.starts_with("run.csv: found a TwinCAT Scope export with the channels 'ActPos', 'ActCurrent'"))
      << hint;
  EXPECT_NE(hint.find("--map"), std::string::npos);
}

}  // namespace
}  // namespace stiction::host
