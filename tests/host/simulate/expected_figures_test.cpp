// The figures that a machine file expects are printed for this machine only.
#include "host/simulate/expected_figures.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "host/report/experiment_table.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/machine_needs.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"

namespace stiction::host {
namespace {

machine::Machine shipped(const std::string& name, const std::string& experiment,
                         const std::vector<std::string>& set = {}) {
  auto machine = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/" + name + ".toml",
                                   {experiment, set});
  if (needs_of(experiment).one_axis) machine.axes.resize(1);
  return machine;
}

std::vector<std::string> models_of(const machine::Machine& machine, const std::string& experiment) {
  std::vector<std::string> names;
  const auto allowed = needs_of(experiment).friction;
  if (machine.axes.empty()) return names;
  for (const auto& [name, parameters] : machine.axes.front().friction.models)
    if (name != sim::CoulombViscous<>::name &&
        (allowed.empty() || std::find(allowed.begin(), allowed.end(), name) != allowed.end()))
      names.push_back(name);
  return names;
}

sim::ExperimentResult run(const std::string& machine_name, const std::string& experiment,
                          const std::vector<std::string>& set = {}) {
  const auto row = std::find_if(experiments().begin(), experiments().end(),
                                [&](const Experiment& each) { return each.name == experiment; });
  const auto machine = shipped(machine_name, experiment, set);
  ExperimentInput input{machine, models_of(machine, experiment), {1e-3}, row->equations};
  return run_experiment(*row, input);
}

sim::ExperimentResult two_figures() {
  sim::ExperimentResult result;
  result.experiment = "impact";
  result.figures = {
      sim::of_model({"peak_deviation_lugre", "um", "peak deviation, lugre", 93.0, {}}, "lugre"),
      sim::of_model({"peak_deviation_classical", "um", "peak deviation, classical", 80.0, {}}, "classical")};
  for (auto& figure : result.figures) figure.axis = "X";
  return result;
}

machine::ExpectedFigure expect_peak(const std::string& value, const std::string& tolerance) {
  machine::ExpectedFigure row;
  row.experiment = "impact";
  row.axis = "X";
  row.figure = "peak_deviation";
  row.value = value;
  row.tolerance = tolerance;
  row.source = "a book";
  row.in_force = true;
  row.place = "m.toml:7: expected[0]";
  return row;
}

TEST(ExpectedFigures, ArePutToTheFiguresThatTheyAreFor) {
  machine::Machine machine;
  machine.expected = {expect_peak("0.09 mm", "4000 nm")};
  auto result = two_figures();
  add_expected_figures(result, machine);
  for (const auto& figure : result.figures) {
    ASSERT_TRUE(figure.expected) << figure.name;
    EXPECT_DOUBLE_EQ(figure.expected->value, 90.0);
    EXPECT_DOUBLE_EQ(figure.expected->tolerance, 4.0);
  }
  EXPECT_EQ(result.figures[0].holds(), true);
  EXPECT_EQ(result.figures[1].holds(), false);

  machine.expected[0].friction = "lugre";
  result = two_figures();
  add_expected_figures(result, machine);
  EXPECT_TRUE(result.figures[0].expected);
  EXPECT_FALSE(result.figures[1].expected);
  EXPECT_TRUE(result.findings.empty());
}

TEST(ExpectedFigures, OfAnotherAxisExperimentOrSettingSayNothing) {
  for (const int which : {0, 1, 2, 3}) {
    machine::Machine machine;
    machine.expected = {expect_peak("90 um", "4 um")};
    auto& row = machine.expected[0];
    if (which == 0) row.axis = "Y";
    if (which == 1) row.experiment = "l-shape";
    if (which == 2) row.in_force = false;
    if (which == 3) row.options["jerk"] = 40.0;
    auto result = two_figures();
    add_expected_figures(result, machine);
    for (const auto& figure : result.figures) EXPECT_FALSE(figure.expected) << which;
    EXPECT_EQ(result.findings.size(), which < 2 ? 0u : 1u) << which;
    EXPECT_EQ(verdict(result), "The machine file states no expected figures for this run.");
  }
  machine::Machine machine;
  machine.expected = {expect_peak("90 um", "4 um")};
  machine.expected[0].options["jerk"] = 40.0;
  machine.expected[0].settings = "--jerk \"40 m/s^3\"";
  auto result = two_figures();
  add_expected_figures(result, machine, {{"jerk", 40.0}});
  EXPECT_TRUE(result.figures[0].expected);
  result = two_figures();
  add_expected_figures(result, machine);
  ASSERT_EQ(result.findings.size(), 1u);
  EXPECT_EQ(result.findings[0], "The machine file has expected figures for runs with --jerk \"40 m/s^3\".");
}

TEST(ExpectedFigures, DoNotPassWithATypo) {
  machine::Machine machine;
  machine.expected = {expect_peak("90 um", "4 um")};
  machine.expected[0].figure = "peak_deviaton";
  auto result = two_figures();
  add_expected_figures(result, machine);
  ASSERT_EQ(result.findings.size(), 1u);
  EXPECT_EQ(result.findings[0],
            "m.toml:7: expected[0]: the figure peak_deviaton was expected; this run has none of that name.");
  machine.expected = {expect_peak("90 N", "4 N")};
  result = two_figures();
  try {
    add_expected_figures(result, machine);
    FAIL() << "took newtons for micrometres";
  } catch (const machine::MachineFileError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("m.toml:7: expected[0].value: found \"90 N\" ")) << error.what();
  }
}

TEST(ExpectedFigures, KnowAFigureWithoutItsModel) {
  EXPECT_EQ(name_without_model(sim::of_model({"current_lugre_at_3.2_m_per_min", "A", "", 0.0, {}}, "lugre")),
            "current_at_3.2_m_per_min");
  EXPECT_EQ(name_without_model(sim::of_model({"period_maxwell_slip", "s", "", 0.0, {}}, "maxwell_slip")), "period");
  EXPECT_EQ(name_without_model({"bandwidth", "Hz", "", 0.0, {}}), "bandwidth");
}

// Rows of the shipped files: each finds its figure, and each but those known holds.
void expect_all(const std::string& machine, const std::string& experiment, const std::vector<std::string>& set,
                const std::vector<std::string>& differing) {
  const auto result = run(machine, experiment, set);
  std::size_t in_force = 0, found = 0;
  for (const auto& row : shipped(machine, experiment, set).expected)
    in_force += row.experiment == experiment && row.in_force && row.options.empty();
  EXPECT_GT(in_force, 0u) << experiment;
  for (const auto& figure : result.figures) {
    if (!figure.expected) continue;
    ++found;
    const bool known = std::find(differing.begin(), differing.end(), figure.name) != differing.end();
    EXPECT_EQ(*figure.holds(), !known) << figure.name << ": " << figure.value << ", expected "
                                       << figure.expected->value;
  }
  EXPECT_GE(found, in_force);
  for (const auto& finding : result.findings) EXPECT_EQ(finding.find("was expected"), std::string::npos) << finding;
}

TEST(ExpectedFigures, OfTheShippedMachinesFindTheirFigures) {
  for (const char* experiment : {"impact", "l-shape", "presliding", "friction-lag", "break-away", "stick-slip"})
    expect_all("mcfv5050ln", experiment, {}, {});
  const std::string gain = "axis.X.velocity_controller.gain=";
  expect_all("mcfv5050ln", "impact", {gain + "851.0638 A s/m"}, {});
  expect_all("mcfv5050ln", "impact", {gain + "691.4894 A s/m"}, {});
}

TEST(ExpectedFigures, OfTheShippedFeedDriveFindTheirs) {
  // The prototype noticed a break-away up to 0.1 ms late.
  expect_all("stick-slip-feed", "feed-cutting", {}, {"critical_beta_at_zeta_0.1"});
}

// A machine of one's own has the table's axes and none of its figures.
TEST(ExpectedFigures, OfAnotherMachineAreNone) {
  for (const char* experiment :
       {"impact", "l-shape", "presliding", "friction-lag", "break-away", "stick-slip", "constant-velocity"}) {
    const auto row = std::find_if(experiments().begin(), experiments().end(),
                                  [&](const Experiment& each) { return each.name == std::string(experiment); });
    auto machine = shipped("mcfv5050ln", experiment);
    machine.expected.clear();
    machine.circle_references.clear();
    machine.steady_friction_references.clear();
    const auto result = run_experiment(*row, {machine, models_of(machine, experiment)});
    for (const auto& figure : result.figures) EXPECT_FALSE(figure.expected) << figure.name;
    for (const auto& chart : result.charts)
      for (const auto& series : chart.series) EXPECT_FALSE(series.points) << chart.title << ": " << series.name;
    EXPECT_EQ(verdict(result), "The machine file states no expected figures for this run.") << experiment;
  }
}

}  // namespace
}  // namespace stiction::host
