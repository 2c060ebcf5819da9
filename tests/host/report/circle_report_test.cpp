// The circle's report as text: escaping, self-containedness, figures, sentences, and the decimation behind its charts.
// What a browser makes of it is open_report.mjs.
#include "host/report/circle_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "host/report/circle_finding.hpp"
#include "host/report/circle_table.hpp"
#include "host/report/machine_sheet.hpp"
#include "host/report/page.hpp"
#include "host/report/reference_lookup.hpp"
#include "sim/machine_file.hpp"
#include "tests/host/report/page_text.hpp"
#include "tests/host/report/synthetic_circle.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::host {
namespace {

constexpr double feed_16 = 16.0 / 60.0;

SyntheticCircle both_directions() {
  SyntheticCircle options;
  options.feeds_m_per_min = {16.0, 48.0};
  options.directions = {sim::Direction::counter_clockwise, sim::Direction::clockwise};
  return options;
}

// ---- the page ----

TEST(CircleReport, HoldsAllRunsModelsFeedsAndBothDirections) {
  const auto report = synthetic_circle(both_directions());
  const auto data = data_of(circle_report_html(report));
  EXPECT_EQ(data["runs"].size(), report.result.runs.size());
  EXPECT_EQ(data["models"].size(), 5u);
  EXPECT_EQ(data["models"][4]["label"], "C LuGre");
  EXPECT_EQ(data["feeds"], nlohmann::json({16.0, 48.0}));
  EXPECT_EQ(data["directions"], nlohmann::json({"ccw", "cw"}));
  EXPECT_EQ(data["table"].size(), 2 * report.result.runs.size());
  EXPECT_TRUE(data["runs"][0].contains("G_b"));
}

TEST(CircleReport, EscapesWhatCouldEndItsElements) {
  auto report = synthetic_circle({.feeds_m_per_min = {48.0}});
  report.title = "</title><script>alert(1)</script> {{data}} & \"quoted\"";
  report.command = "stiction --set 'a<b'";
  report.machine.name = "</script><!--<script>";
  const auto page = circle_report_html(report);
  EXPECT_EQ(count(page, "<script>alert"), 0u);
  EXPECT_NE(page.find("&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt; {{data}} &amp; &quot;quoted&quot;"),
            std::string::npos);
  EXPECT_NE(page.find("stiction --set &#39;a&lt;b&#39;"), std::string::npos);
  EXPECT_EQ(data_of(page)["machine"]["name"], report.machine.name);
}

TEST(CircleReport, RepairsTextThatIsNotUtf8) {
  auto report = synthetic_circle({.feeds_m_per_min = {48.0}});
  report.machine.name = "caf\xe9";
  EXPECT_EQ(data_of(circle_report_html(report))["machine"]["name"], "caf\xef\xbf\xbd");
}

TEST(CircleReport, LoadsNothing) {
  const auto page = without_chart_library(circle_report_html(synthetic_circle({.feeds_m_per_min = {48.0}})));
  ASSERT_FALSE(page.empty());
  const std::regex loading(R"(\bsrc\s*=|<link\b|@import|url\(|https?://(?!www\.w3\.org/2000/svg))", std::regex::icase);
  std::smatch found;
  EXPECT_FALSE(std::regex_search(page, found, loading)) << found.str();
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(CircleReport, KeepsTheNoticeOfTheChartLibrary) {
  const auto page = circle_report_html(synthetic_circle({.feeds_m_per_min = {48.0}}));
  EXPECT_NE(page.find("The MIT License (MIT)"), std::string::npos);
  EXPECT_NE(page.find("Copyright (c) 2021 Plotly, Inc"), std::string::npos);
}

TEST(CircleReport, LeavesNoMarkerOfTheTemplate) {
  const auto page = circle_report_html(synthetic_circle({.feeds_m_per_min = {48.0}}));
  EXPECT_FALSE(std::regex_search(page.substr(0, page.find("id=\"data\"")), std::regex(R"(\{\{\w+\}\})")));
}

TEST(CircleReport, OfThirtyRunsIsBelowFourMegabytesBesideTheLibrary) {
  auto options = SyntheticCircle{};
  options.feeds_m_per_min = {3.2, 8.0, 16.0, 24.0, 32.0, 48.0};
  const auto page = circle_report_html(synthetic_circle(options));
  EXPECT_LT(page.size(), 1'100'000u + 4'000'000u);
}

TEST(CircleReport, RefusesAResultWithoutRunsAndLapsOfUnequalLength) {
  auto report = synthetic_circle({.feeds_m_per_min = {48.0}});
  report.result.runs[0].axes[1].current.pop_back();
  EXPECT_THROW(circle_report_html(report), std::invalid_argument);
  report.result.runs.clear();
  EXPECT_THROW(circle_report_html(report), std::invalid_argument);
}

// ---- the sentence ----

TEST(CircleFinding, NamesTheActingModelsLargestErrorBesideTheMeasurement) {
  const auto report = synthetic_circle();
  const auto finding = circle_finding(report.result, report.machine);
  EXPECT_NEAR(finding.feed, feed_16, 1e-9);
  EXPECT_TRUE(finding.sentence.starts_with("At 16 m/min the largest quadrant error is 8.")) << finding.sentence;
  EXPECT_NE(finding.sentence.find(" µm (Y, C LuGre); the measured value is 8.5 µm, and over all measured feeds"),
            std::string::npos)
      << finding.sentence;
  EXPECT_NE(finding.sentence.find("(X) and"), std::string::npos) << finding.sentence;
}

TEST(CircleFinding, ComparesWithThePublicationWhereNothingWasMeasured) {
  const auto report = synthetic_circle({.measured = false});
  const auto finding = circle_finding(report.result, report.machine);
  EXPECT_TRUE(finding.sentence.ends_with("; the published simulation gives 9.0 µm.")) << finding.sentence;
}

TEST(CircleFinding, SaysThatThereIsNothingToCompareWith) {
  const auto report = synthetic_circle({.measured = false, .published = false});
  const auto finding = circle_finding(report.result, report.machine);
  EXPECT_TRUE(finding.sentence.ends_with("; no measured or published value is available.")) << finding.sentence;
}

// ---- table ----

TEST(CircleTable, ReproducesTheSourcesMeanErrorsFromItsOwnRows) {
  const auto report = synthetic_circle();
  for (const auto& mean : mean_deviations(circle_table(report.result, report.machine)))
    if (mean.friction == "classical" && mean.axis == "X") {
      EXPECT_NEAR(*mean.error_published, 1.23, 0.005);    // Tab 6.4: 123 %
      EXPECT_NEAR(*mean.current_published, 0.06, 0.006);  // 6 %
    }
}

TEST(CircleTable, MarksAQuantisedErrorOfAnotherIncrement) {
  auto report = synthetic_circle({.feeds_m_per_min = {16.0}});
  auto& lap = report.result.runs[4].axes[0];  // LuGre; published 7 um
  lap.peak_error_quantised = 7e-6;
  EXPECT_FALSE(circle_table(report.result, report.machine)[4].error_quantised.differs);
  lap.peak_error_quantised = 8e-6;
  EXPECT_TRUE(circle_table(report.result, report.machine)[4].error_quantised.differs);
}

TEST(CircleTable, LeavesOutWhatTheMachineFileDoesNotHave) {
  const auto report = synthetic_circle({.feeds_m_per_min = {16.0}, .measured = false, .published = false});
  for (const auto& row : circle_table(report.result, report.machine)) {
    EXPECT_FALSE(row.error.measured || row.error.published || row.error.deviation());
    EXPECT_FALSE(row.error_quantised.differs || row.current.differs);
  }
}

TEST(ReferenceLookup, FindsAFeedThatWentThroughMetresPerMinute) {
  const auto report = synthetic_circle({.feeds_m_per_min = {48.0}});
  const double feed = 3.2 * (1.0 / 60.0);
  EXPECT_DOUBLE_EQ(find_measured(report.machine, "X", feed)->error, 2e-6);
  EXPECT_DOUBLE_EQ(find_published(report.machine, "Y", "lugre", feed)->current, 3.2);
  EXPECT_EQ(find_published(report.machine, "Y", "coulomb_viscous", feed), nullptr);
  EXPECT_EQ(find_measured(report.machine, "X", 3.3 / 60.0), nullptr);
}

TEST(MachineSheet, PrintsEngineeringUnitsAndLeavesOutWhatNoAxisHas) {
  auto machine = synthetic_circle({.feeds_m_per_min = {48.0}}).machine;
  for (auto& axis : machine.axes) axis.notch.reset();
  const auto value = [&](const std::string& section, const std::string& label, const std::string& unit) {
    for (const auto& each : machine_sheet(machine))
      for (const auto& row : each.rows)
        if (each.title == section && row.label == label && row.unit == unit) return row.values.at(0);
    return std::string("absent");
  };
  EXPECT_EQ(value("Axis", "largest velocity", "m/min"), "80");
  EXPECT_EQ(value("Encoder", "increment after interpolation", "nm"), "1");
  EXPECT_EQ(value("Friction C LuGre", "contact stiffness k_s", "N/µm"), "0.8");
  EXPECT_EQ(value("Friction C LuGre", "Stribeck velocity v_s", "mm/s"), "1");
  EXPECT_EQ(value("Notch", "centre frequency, below half the fast loop's rate", "Hz"), "absent");
  EXPECT_EQ(value("Friction Maxwell-slip elements", "viscous friction mu_v", "N s/m"), "absent");
  EXPECT_EQ(value("Velocity controller", "integral time T_Nv", "ms"), "5");
  EXPECT_EQ(value("Supervision", "following error", ""), "2 mm");
  machine.axes[0].velocity_controller.integral_time.reset();
  EXPECT_EQ(value("Velocity controller", "integral time T_Nv", "ms"), "proportional only");
}

TEST(MachineSheet, ShowsWhatAForceMotorHasInItsOwnUnits) {
  auto machine = synthetic_circle({.feeds_m_per_min = {48.0}}).machine;
  auto& axis = machine.axes[0];
  axis.motor = {.model = machine::MotorModel::force, .force_constant = 35.0};
  axis.current_controller.reset();
  std::vector<std::string> found;
  for (const auto& section : machine_sheet(machine))
    for (const auto& row : section.rows)
      if (!row.values.at(0).empty() && (section.title == "Motor" || section.title == "Current controller"))
        found.push_back(row.values[0] + " " + row.unit);
  EXPECT_EQ(found, (std::vector<std::string>{"force ", "0 mH", "35 N/V", "1 ", "they stay cold ", "600 s"}));
}

TEST(MachineSheet, HasTheWordsAndUnitsOfARotaryAxis) {
  const auto machine =
      sim::parse_machine("joint.toml", test::rotary_joint + "[axis.J.gravity]\nmoment = \"0.4 N m\"\n");
  std::vector<std::string> found;
  for (const auto& section : machine_sheet(machine))
    for (const auto& row : section.rows) {
      found.push_back(row.label + " | " + row.unit);
      EXPECT_EQ(row.label.find("force"), std::string::npos) << row.label;
      EXPECT_EQ(row.label.find("mass"), std::string::npos) << row.label;
    }
  for (const char* row : {"moving inertia | kg cm²", "moment of the load's weight about the rest below | N m",
                          "torque constant of the whole motor, amplitude amperes | N m/V"})
    EXPECT_NE(std::find(found.begin(), found.end(), row), found.end()) << row;
}

// ---- packing ----

TEST(Page, PacksFloatsAsLittleEndianBase64) {
  const std::vector<float> values{1.0f, -2.5f};
  EXPECT_EQ(base64_floats(values), "AACAPwAAIMA=");  // 00 00 80 3f 00 00 20 c0
  EXPECT_EQ(base64_floats({}), "");
}

TEST(Page, RefusesATemplateThatDoesNotMatchItsTexts) {
  EXPECT_EQ(fill_template("a {{x}} b", {{"x", "{{x}}"}}), "a {{x}} b");
  EXPECT_THROW(fill_template("{{x}}", {}), std::invalid_argument);
  EXPECT_THROW(fill_template("a", {{"x", ""}}), std::invalid_argument);
  EXPECT_THROW(fill_template("{{x", {{"x", ""}}), std::invalid_argument);
}

}  // namespace
}  // namespace stiction::host
