// Rows [[expected]]: their keys, and the machine for which they are in force.
#include <gtest/gtest.h>

#include <algorithm>

#include "firmware/machine/file/edited_machine.hpp"
#include "firmware/machine/file/expected_parameters.hpp"
#include "sim/machine_file.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::machine::test {
namespace {

const std::string row = R"([[expected]]
experiment = "impact"
axis = "B"
friction = "lugre"
figure = "peak_deviation"
value = "92 um"
tolerance = "2 um"
source = "a book, p. 3"
)";

Machine machine_of(const std::string& more, const ReadOptions& options = {}) {
  return sim::parse_machine("m.toml", small_machine + more, options);
}

std::string error_of_row(const std::string& from, const std::string& to) {
  try {
    machine_of(replaced(row, from, to));
  } catch (const MachineFileError& error) {
    return error.what();
  }
  return "read";
}

TEST(ExpectedFigures, AreReadAsTheyAreWritten) {
  const auto rows = machine_of(row +
                               "\n[[expected]]\nexperiment = \"impact\"\nfigure = \"return_time\"\n"
                               "value = 0.5\ntolerance = 0\nsource = \"s\"\n")
                        .expected;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].experiment, "impact");
  EXPECT_EQ(rows[0].axis, "B");
  EXPECT_EQ(rows[0].friction, "lugre");
  EXPECT_EQ(rows[0].figure, "peak_deviation");
  EXPECT_EQ(rows[0].value, "92 um");
  EXPECT_EQ(rows[0].tolerance, "2 um");
  EXPECT_EQ(rows[0].source, "a book, p. 3");
  EXPECT_EQ(rows[0].place, "m.toml:29: expected[0]");
  EXPECT_TRUE(rows[0].in_force);
  EXPECT_EQ(rows[1].axis, "B") << "the only one";
  EXPECT_FALSE(rows[1].friction);
  EXPECT_EQ(rows[1].value, "0.5");
}

TEST(ExpectedFigures, RefuseWhatTheyCannotBe) {
  EXPECT_EQ(error_of_row("figure = ", "figur = "),
            "m.toml:33: expected[0].figur: found an unknown key; expected one of experiment, axis, friction, figure, "
            "source, value, tolerance, when; did you mean \"figure\"?");
  EXPECT_EQ(error_of_row("source = \"a book, p. 3\"\n", ""),
            "m.toml:29: expected[0].source: found no such key; expected a text (document and place)");
  EXPECT_TRUE(error_of_row("\"impact\"", "\"impct\"").ends_with("did you mean \"impact\"?"));
  EXPECT_EQ(error_of_row("axis = \"B\"", "axis = \"spindle\""),
            "m.toml:31: expected[0].axis: found \"spindle\"; expected an axis of this machine: \"B\"");
  EXPECT_TRUE(error_of_row("\"lugre\"", "\"lugrr\"").ends_with("did you mean \"lugre\"?"));
  EXPECT_TRUE(error_of_row("\"92 um\"", "\"92 uq\"")
                  .starts_with("m.toml:34: expected[0].value: found \"92 uq\" (unknown unit \"uq\"; did you mean "
                               "\"um\"?); expected a number"));
  EXPECT_TRUE(error_of_row("\"92 um\"", "true").starts_with("m.toml:34: expected[0].value: found true; expected"));
  EXPECT_TRUE(error_of_row("\"2 um\"", "\"2 N\"")
                  .starts_with("m.toml:35: expected[0].tolerance: found \"2 N\" (dimension m kg s^-2, not m)"));
  EXPECT_TRUE(error_of_row("\"2 um\"", "\"-2 um\"").ends_with("expected a tolerance of at least 0"));
  EXPECT_EQ(error_of_row("[[expected]]", "[expected]"),
            "m.toml:29: expected: found a table; expected rows [[expected]]");
  try {
    machine_of(row + row);
    FAIL() << "read twice";
  } catch (const MachineFileError& error) {
    EXPECT_STREQ(
        error.what(),
        "m.toml:37: expected[1]: found the figure of expected[0] again; expected one row for each figure, axis, "
        "friction model and set of overrides");
  }
}

TEST(ExpectedFigures, RefuseConditionsThatTheFileCannotMeet) {
  const auto error = [](const std::string& when) { return error_of_row("source =", "when = " + when + "\nsource ="); };
  EXPECT_TRUE(error("3").starts_with("m.toml:36: expected[0].when: found 3; expected a table"));
  const auto typo = error("{ \"axis.B.mas\" = \"3 kg\" }");
  EXPECT_TRUE(typo.starts_with("m.toml:29: expected[0].when: found axis.B.mas=3 kg ")) << typo;
  EXPECT_NE(typo.find("did you mean \"mass\"?"), std::string::npos) << typo;
  EXPECT_NE(error("{ \"axis.B.mass\" = \"3 s\" }").find("dimension s, not kg"), std::string::npos);
  EXPECT_TRUE(error("{ axis.B.mass = \"3 kg\" }")
                  .ends_with("found a table; expected a text or a number, with the whole "
                             "key in quotes"));
  EXPECT_TRUE(
      error("{ jerk = \"40 m/s^3\" }").ends_with("an override such as \"axis.X.mass\", or an option of impact"));
  const auto of_l_shape = [](const std::string& when) {
    return machine_of(replaced(row, "impact", "l-shape") + "when = " + when + "\n");
  };
  EXPECT_EQ(of_l_shape("{ jerk = \"40 m/s^3\" }").expected.at(0).options.at("jerk"), 40.0);
  EXPECT_EQ(of_l_shape("{ jerk = \"40 m/s^3\" }").expected.at(0).settings, "--jerk \"40 m/s^3\"");
  EXPECT_THROW(of_l_shape("{ jerk = \"40 m/s^2\" }"), MachineFileError);
}

// Whether the row counts in a run with these overrides.
bool counts(const std::string& when, const std::vector<std::string>& set, const std::string& more = "") {
  const auto with_when = when.empty() ? row : row + "when = " + when + "\n";
  return machine_of(more + with_when, {"impact", set}).expected.at(0).in_force;
}

TEST(ExpectedFigures, CountForTheFileAsItIs) {
  EXPECT_TRUE(counts("", {}));
  EXPECT_FALSE(counts("", {"axis.B.mass=90 kg"}));
  EXPECT_FALSE(counts("", {"timing.slow_period=2 ms"}));
  EXPECT_FALSE(counts("", {"axis.B.friction.lugre.coulomb=21 N"}));
  EXPECT_FALSE(
      counts("", {"axis.B.notch={ frequency = \"100 Hz\", numerator_damping = 0.1, denominator_damping = 1 }"}));
  // The same in other words, names, and another friction model change nothing of this figure.
  EXPECT_TRUE(counts("", {"axis.B.mass=95000 g"}));
  EXPECT_TRUE(counts("", {"name=other"}));
  EXPECT_TRUE(counts("", {"axis.B.friction.coulomb_viscous={ coulomb = \"20 N\", viscous = \"200 N s/m\" }",
                          "axis.B.friction.use=coulomb_viscous"}));
  // Overrides of the experiment are the file's own.
  EXPECT_TRUE(counts("", {}, "[experiment.impact.axis.B]\nmass = \"80 kg\"\n"));
  EXPECT_TRUE(counts("", {"axis.B.mass=80 kg"}, "[experiment.impact.axis.B]\nmass = \"80 kg\"\n"));
}

TEST(ExpectedFigures, CountUnderTheOverridesThatTheyName) {
  const std::string heavy = "{ \"axis.B.mass\" = \"100 kg\" }";
  EXPECT_FALSE(counts(heavy, {}));
  EXPECT_TRUE(counts(heavy, {"axis.B.mass=100 kg"}));
  EXPECT_TRUE(counts(heavy, {"axis.*.mass=0.1 t"}));
  EXPECT_FALSE(counts(heavy, {"axis.B.mass=101 kg"}));
  EXPECT_FALSE(counts(heavy, {"axis.B.mass=100 kg", "axis.B.travel=1 m"}));
  // An empty value removes a key.
  const std::string pi = "axis.B.velocity_controller.integral_time";
  EXPECT_TRUE(counts("{ \"" + pi + "\" = \"5 ms\" }", {pi + "=5 ms"}));
  EXPECT_TRUE(counts("{ \"axis.B.encoder.velocity\" = \"\" }", {"axis.B.encoder.velocity="}));
  EXPECT_FALSE(counts("{ \"axis.B.encoder.velocity\" = \"\" }", {}));
}

TEST(ExpectedFigures, OfOneAxisDoNotAskForTheOther) {
  const auto in_force = [&](const std::vector<std::string>& set, const std::string& axis, bool notch) {
    int count = 0;
    for (const auto& each : sim::read_machine(shipped_machine(), {"frequency-response", set}).expected)
      count += each.experiment == "frequency-response" && each.axis == axis && each.in_force &&
               each.overrides.empty() != notch;
    return count;
  };
  EXPECT_EQ(in_force({}, "X", false), 3);
  EXPECT_EQ(in_force({"axis.Y.mass=500 kg"}, "X", false), 3);
  EXPECT_EQ(in_force({"axis.Y.mass=500 kg"}, "Y", false), 0);
  EXPECT_EQ(in_force({"axis.*.notch="}, "X", false), 0);
  EXPECT_EQ(in_force({"axis.*.notch="}, "X", true), 1);
  EXPECT_EQ(in_force({"axis.X.notch="}, "Y", true), 0);
}

TEST(ExpectedFigures, StayWithTheMachineThatTheyAreOf) {
  const MachineFileOnDisk file("# contact\n" + small_machine + "# what is expected\n" + row);
  const Effect effect{"constant_force", {{"force", {3.0}}}};
  const std::vector<AxisEffects> additions{{"B", {effect}}};
  const auto extended = sim::extended_machine(file.path(), {}, additions, {});
  EXPECT_EQ(extended.find("expected"), std::string::npos) << extended;
  EXPECT_NE(extended.find("# contact"), std::string::npos) << "other comments stay";
  EXPECT_NE(sim::extended_machine(file.path(), {}, {}, {}).find("[[expected]]"), std::string::npos);
  const std::vector<MachineEdit> edits{{{"axis", "B", "mass"}, std::string("90 kg")}};
  EXPECT_TRUE(sim::parse_machine("m.toml", edited_machine(file.path(), {}, edits, {})).expected.empty());
}

TEST(ExpectedFigures, AreOnTheReferencePage) {
  const auto& tables = sim::machine_file_description();
  const auto table = std::find_if(tables.begin(), tables.end(), [](const auto& t) { return t.name == "[expected]"; });
  ASSERT_NE(table, tables.end());
  EXPECT_EQ(table->keys.size(), expected_texts.size() + expected_quantities.size() + 1);
}

}  // namespace
}  // namespace stiction::machine::test
