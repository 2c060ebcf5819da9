// The published measurements of the cross table: causes from the rows that may be used, score on those that were not.
#include "host/diagnose/reference/reference_diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host/diagnose/reference/reference_extension.hpp"
#include "host/identify/measured_machine.hpp"
#include "host/simulate/circle.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

std::filesystem::path machine_file() {
  return std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";
}

TEST(ReferenceDiagnosis, halves_the_current_error_on_feeds_not_used) {
  const auto machine = sim::read_machine(machine_file());
  const auto verdict = host::diagnose_reference(machine);
  ASSERT_TRUE(verdict.reference);
  const auto& unused = verdict.reference->unused;
  const auto& left_out = verdict.reference->left_out;
  figure("diagnosis of the measured rows: mean current error, feeds not used",
         fmt::format("{:.1f} %, published simulation {:.1f} % (bound half of it)", 100.0 * unused.extended.current,
                     100.0 * unused.published.current));
  figure("diagnosis of the measured rows: the same, each feed left out in turn",
         fmt::format("{:.1f} %, published simulation {:.1f} % (bound half of it)", 100.0 * left_out.extended.current,
                     100.0 * left_out.published.current));
  figure("diagnosis of the measured rows: error at reversals, feeds not used",
         fmt::format("{:.1f} %, published simulation {:.1f} %, machine file {:.1f} %", 100.0 * unused.extended.error,
                     100.0 * unused.published.error, 100.0 * unused.machine_file.error));
  EXPECT_LE(unused.extended.current, 0.5 * unused.published.current);
  EXPECT_LE(left_out.extended.current, 0.5 * left_out.published.current);
  EXPECT_EQ(verdict.reference->rows.size(), 10u);

  // Every axis' friction is named, by its sliding law and its contact; mass is not.
  for (const char* axis : {"X", "Y"})
    for (const char* effect : {"viscous_nonlinear", "presliding_hysteresis"})
      EXPECT_TRUE(std::any_of(verdict.findings.begin(), verdict.findings.end(),
                              [&](const host::Finding& f) { return f.axis == axis && f.effect.name() == effect; }))
          << axis << effect;
  EXPECT_TRUE(std::any_of(verdict.rejected.begin(), verdict.rejected.end(),
                          [](const host::Rejected& r) { return r.effect.name() == "mass_mismatch"; }));

  // The extended file is a machine that gives the extended rows.
  std::vector<machine::AxisEffects> additions{{"X", {}}, {"Y", {}}};
  for (const auto& finding : verdict.findings) additions[finding.axis == "X" ? 0 : 1].effects.push_back(finding.row());
  const auto extended = sim::parse_machine("extended.toml", sim::extended_machine(machine_file(), {}, additions, {}));
  const auto run = host::reference_circle(extended, 24.0 / 60.0);
  for (const auto& row : verdict.reference->rows) {
    if (std::abs(row.feed - 0.4) > 1e-9) continue;
    EXPECT_NEAR(run.axes[row.axis == "X" ? 0 : 1].peak_current, row.extended.current, 1e-3);
  }
}

// To the bit: no axis of the cross table feels the other, and the lap is the same one.
TEST(ReferenceDiagnosis, drives_each_axis_alone_on_the_circle_of_both) {
  auto machine = sim::read_machine(machine_file());
  host::ReferenceCircles circles;
  for (const double viscous : {0.0, 20.0}) {
    if (viscous > 0.0) machine.axes[1].effects.push_back({"viscous_mismatch", {{"viscous", {viscous}}}});
    const double feed = 48.0 / 60.0;
    const auto figures = circles.at(machine, feed), again = circles.at(machine, feed);
    const auto run = host::reference_circle(machine, feed);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(figures[k].error, run.axes[k].peak_error);
      EXPECT_EQ(figures[k].current, run.axes[k].peak_current);
      EXPECT_EQ(again[k].error, figures[k].error);
    }
  }
}

TEST(ReferenceDiagnosis, looks_at_no_row_but_those_of_the_training) {
  const auto machine = sim::read_machine(machine_file());
  auto other = machine;
  for (auto& row : other.circle_references)
    if (std::abs(row.feed - host::calibration_feed) > 1e-6) row.error = row.current = 1e3;
  host::ReferenceCircles circles, of_other;
  const auto extension = host::extend_by_rows(machine, host::calibration_feed, circles);
  const auto with_other_rows = host::extend_by_rows(other, host::calibration_feed, of_other);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto effects = host::effects_of(machine, extension, axis);
    const auto again = host::effects_of(other, with_other_rows, axis);
    ASSERT_EQ(effects.size(), again.size());
    for (std::size_t k = 0; k < effects.size(); ++k) EXPECT_EQ(effects[k].values, again[k].values);
  }
}

TEST(ReferenceDiagnosis, names_no_part_of_a_law_that_the_file_has_already) {
  std::vector<host::SteadyPoint> points;
  for (int k = 0; k < 12; ++k) {
    const double v = 3e-4 * std::pow(2.0, k);
    points.push_back({v, 90.0 + 500.0 * v + (k % 2 == 0 ? 1.0 : -1.0) * (1.0 + 0.3 * k)});  // a scatter of 1 to 4 N
  }
  for (const auto& test : host::fit_sliding_law(points, {90.0, 500.0, 0.0, 0.0}).tests) EXPECT_FALSE(test.named);
  for (auto& point : points) point.force += 40.0 * -std::expm1(-point.velocity / 0.02);
  const auto fit = host::fit_sliding_law(points, {90.0, 500.0, 0.0, 0.0});
  EXPECT_FALSE(fit.tests[0].named);
  EXPECT_FALSE(fit.tests[1].named);
  EXPECT_TRUE(fit.tests[2].named);
  EXPECT_NEAR(fit.law.rise, 40.0, 3.0 * fit.errors.rise + 1e-9);
}

TEST(ReferenceDiagnosis, says_which_rows_are_missing) {
  auto machine = sim::read_machine(machine_file());
  machine.steady_friction_references.clear();
  EXPECT_THROW(host::diagnose_reference(machine), host::MissingRows);
}

}  // namespace
}  // namespace stiction::test
