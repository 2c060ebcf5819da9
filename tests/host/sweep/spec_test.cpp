// Specifications of sweeps: their rows, and what is refused.
#include "host/sweep/spec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "firmware/machine/file/machine_file.hpp"
#include "host/sweep/commands.hpp"
#include "host/sweep/rows.hpp"

namespace stiction::host {
namespace {

constexpr const char* head = "schema = \"stiction.sweep-spec/1\"\ncommand = \"simulate circle\"\n";
const std::string cross_table = STICTION_SOURCE_DIR "/firmware/machine/shipped/mcfv5050ln.toml";

std::string with(const std::string& rest) { return head + ("machine = \"" + cross_table + "\"\n") + rest; }

SweepSpec parsed(const std::string& text) { return parse_sweep_spec("s.toml", text); }

std::string refusal(const std::string& text) {
  try {
    const auto spec = parsed(text);
    command_of(spec);
    const SweepRows rows(spec, command_of(spec));
    rows.row(0);
  } catch (const machine::MachineFileError& error) {
    return error.what();
  }
  return "not refused";
}

void expect_refusal(const std::string& text, const std::string& words) {
  const auto found = refusal(text);
  EXPECT_NE(found.find(words), std::string::npos) << text << "\n" << found;
}

TEST(SweepSpecFile, AGridHasEveryCombinationTheLastKeyFastest) {
  const auto spec =
      parsed(with("[option]\nfeed = [\"8 m/min\", \"16 m/min\"]\n[set]\n\"axis.X.mass\" = { from = \"200 "
                  "kg\", to = \"300 kg\", steps = 3 }\n"));
  ASSERT_EQ(spec.rows(), 6U);
  const SweepRows rows(spec, command_of(spec));
  EXPECT_EQ(rows.row(0).set.front(), "axis.X.mass=200 kg");
  EXPECT_EQ(rows.row(1).set.front(), "axis.X.mass=250 kg");
  EXPECT_EQ(rows.row(2).set.front(), "axis.X.mass=300 kg");
  EXPECT_EQ(rows.row(2).option("feed"), "8 m/min");
  EXPECT_EQ(rows.row(3).option("feed"), "16 m/min");
  EXPECT_EQ(rows.command_line(rows.row(3)),
            "stiction simulate circle --machine " + cross_table + " --feed '16 m/min' --set 'axis.X.mass=200 kg'");
}

TEST(SweepSpecFile, KeysMayBeWrittenAsTables) {
  const auto spec = parsed(with("[set.axis.X]\nmass = [\"200 kg\", \"0.3 t\"]\n"));
  ASSERT_EQ(spec.keys.size(), 2U);
  EXPECT_EQ(spec.keys[1].column(), "axis.X.mass[kg]");
  EXPECT_DOUBLE_EQ(spec.keys[1].numbers[1], 300.0);
}

TEST(SweepSpecFile, ARelativeKeyMultipliesWhatTheFileHas) {
  const auto spec =
      parsed(with("[set]\n\"axis.*.mass\" = { values = [0.5, 2], relative = true }\n"
                  "\"axis.X.friction_compensation.friction.level\" = { values = [2.0], relative = true }\n"));
  const SweepRows rows(spec, command_of(spec));
  const auto row = rows.row(1);
  ASSERT_EQ(row.set.size(), 3U);
  EXPECT_EQ(row.set[0], "axis.X.mass=\"450 kg\"");
  EXPECT_EQ(row.set[1], "axis.Y.mass=\"1040 kg\"");
  EXPECT_TRUE(row.set[2].starts_with("axis.X.friction_compensation.friction.level=[\"0.1388 A\", \"0.296 A\""))
      << row.set[2];
}

TEST(SweepSpecFile, DrawsHaveTheirDistributions) {
  const auto spec =
      parsed(with("[set]\n\"axis.X.mass\" = { distribution = \"normal\", mean = \"200 kg\", deviation = "
                  "\"4 kg\" }\n\"axis.Y.mass\" = { distribution = \"log-uniform\", from = \"1 kg\", to = "
                  "\"100 kg\" }\n[sample]\nnumber = 2000\nseed = 9\n"));
  const SweepRows rows(spec, command_of(spec));
  double sum = 0.0, squares = 0.0;
  std::size_t below_ten = 0;
  for (std::uint64_t k = 0; k < rows.size(); ++k) {
    const auto values = rows.values(k);
    sum += values.numbers[1];
    squares += (values.numbers[1] - 200.0) * (values.numbers[1] - 200.0);
    below_ten += values.numbers[2] < 10.0;
  }
  EXPECT_NEAR(sum / 2000.0, 200.0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / 2000.0), 4.0, 0.05);
  EXPECT_EQ(below_ten, 1000U) << "half of the decades, and each part of a Latin hypercube has one point";
}

TEST(SweepSpecFile, DrawsAreTheSameInEveryCombinationOfTheGrid) {
  const auto spec =
      parsed(with("[set]\n\"axis.X.mass\" = { distribution = \"uniform\", from = \"200 kg\", to = \"250 "
                  "kg\" }\n\"axis.Y.mass\" = [\"500 kg\", \"600 kg\"]\n[sample]\nnumber = 5\n"));
  const SweepRows rows(spec, command_of(spec));
  ASSERT_EQ(rows.size(), 10U);
  for (std::uint64_t k = 0; k < 5; ++k) EXPECT_EQ(rows.values(k).numbers[1], rows.values(k + 5).numbers[1]);
}

TEST(SweepSpecFile, SaysWhatWasFoundAndExpected) {
  expect_refusal("schema = \"x\"", "s.toml:1: schema: found a different one; expected \"stiction.sweep-spec/1\"");
  expect_refusal(with("colour = 3"), "colour: found an unknown key; expected one of schema, name, command");
  expect_refusal(head, "machine: found no such key; expected the machine, or a list of them");
  expect_refusal("schema = \"stiction.sweep-spec/1\"\nmachine = \"emps\"", "command: found no such key");
  expect_refusal("schema = \"stiction.sweep-spec/1\"\nmachine = \"emps\"\ncommand = \"simulate circel\"",
                 "command: found \"simulate circel\"; expected one of simulate circle, tune-friction");
  expect_refusal("schema = \"stiction.sweep-spec/1\"\nmachine = \"emps\"\ncommand = \"simulate impact\"",
                 "option.friction: found no such key; expected one value, or a list");
  expect_refusal("schema = \"stiction.sweep-spec/1\"\nmachine = \"emps\"\ncommand = \"diagnose\"",
                 "log: found no such key; expected a log, or a list");
  expect_refusal(with("log = \"a.csv\""), "log: found logs; expected none, as simulate circle reads no logs");
  expect_refusal(with("[option]\nfeet = \"16 m/min\""), "did you mean \"feed\"?");
  expect_refusal(with("[option]\nfeed = []"), "option.feed: found an empty list; expected at least one value");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { from = \"1 kg\", to = \"2 kg\" }"),
                 "distribution: found neither it nor steps");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { from = \"1 kg\", to = \"2 m\", steps = 3 }"),
                 "to: found \"2 m\"; expected a quantity in kg");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { from = \"2 kg\", to = \"1 kg\", steps = 3 }"),
                 "to: found 1; expected more than from, 2");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { from = \"1 kg\", to = \"2 kg\", steps = 1 }"),
                 "steps: found 1; expected a whole number from 2 to 1000000");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { distribution = \"uniform\", from = \"1 kg\", to = \"2 kg\" }"),
                 "sample: found no such table, but keys with a distribution");
  expect_refusal(with("[sample]\nnumber = 3"), "sample: found it without a key that has a distribution");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { distribution = \"log-uniform\", from = \"0 kg\", to = \"2 kg\" }"),
                 "from: found 0; expected a value above 0");
  expect_refusal(with("[set]\n\"axis.X.mass\" = { values = [\"1 kg\"], relative = true }"),
                 "found values that are no plain");
  expect_refusal(with("[set]\n\"axis.X.massive\" = { values = [1.0], relative = true }"),
                 "axis.X.massive: found no such key; expected one that the file has");
  expect_refusal(with("[set]\n\"axis.X.motor.model\" = { values = [1.0], relative = true }"),
                 "expected a quantity or a list of quantities, which a sweep can multiply");
  expect_refusal(with("robust = \"peak_error\""), "robust: found it without a key that has design = true");
  expect_refusal(with("pareto = [\"peak_error\"]"), "pareto: found a list of 1; expected two figures");
  expect_refusal(with("[option]\nfeed = { values = [\"8 m/min\"], relative = true }"),
                 "relative: found true; expected a key of the machine file");
}

TEST(SweepSpecFile, TheNumberOfRowsDoesNotOverflow) {
  std::string text = "[set]\n";
  for (const char* key : {"a", "b", "c", "d", "e", "f"})
    text += std::string("\"axis.X.") + key + "\" = { from = 1, to = 2, steps = 1000000 }\n";
  EXPECT_EQ(parsed(with(text)).rows(), std::uint64_t{1} << 62U);
}

}  // namespace
}  // namespace stiction::host
