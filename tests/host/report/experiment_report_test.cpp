// An experiment's report as text: escaping, self-containedness, what the charts keep, the figures' table, the verdict.
// What a browser makes of it is open_experiment.mjs.
#include "host/report/experiment_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "host/report/experiment_table.hpp"
#include "host/report/typeset.hpp"
#include "tests/host/report/page_text.hpp"
#include "tests/host/report/synthetic_experiment.hpp"

namespace stiction::host {
namespace {

TEST(ExperimentReport, HoldsChartsSeriesAndFigures) {
  const auto report = synthetic_experiment();
  const auto data = data_of(experiment_report_html(report));
  ASSERT_EQ(data["charts"].size(), 3u);
  EXPECT_EQ(data["charts"][0]["y_label"], "deviation at the encoder, µm");
  EXPECT_EQ(data["charts"][0]["series"].size(), 4u);
  ASSERT_EQ(data["series"].size(), 4u);  // each once, whatever the number of charts
  EXPECT_EQ(data["series"][3]["name"], "lugre");
  EXPECT_EQ(data["series"][3]["label"], "C LuGre");
  EXPECT_EQ(data["series"][3]["model"], "lugre");
  EXPECT_EQ(data["figures"].size(), report.result.figures.size());
}

TEST(ExperimentReport, GivesAVariantItsModelAndAnotherNameNone) {
  const auto data = data_of(experiment_report_html(synthetic_friction_bench()));
  EXPECT_EQ(data["series"][1]["label"], "C LuGre, 5400 N/s");
  EXPECT_EQ(data["series"][1]["model"], "lugre");
  EXPECT_EQ(data["series"][2]["name"], "measured");
  EXPECT_TRUE(data["series"][2]["points"].get<bool>());
  EXPECT_TRUE(data["series"][3]["model"].is_null());  // "1 rad/s"
}

TEST(ExperimentReport, EscapesWhatCouldEndItsElements) {
  auto report = synthetic_experiment();
  auto& result = report.result;
  const std::string bad = "</script><!--<script>alert(1)</script> {{data}} & \"q\"";
  result.title = result.experiment = result.question = result.findings[0] = bad;
  result.figures[0].text = result.figures[0].expected->source = bad;
  result.charts[0].title = result.charts[0].caption = result.charts[0].series[0].name = bad;
  report.command = report.version = bad;
  const auto page = experiment_report_html(report);
  EXPECT_EQ(count(page, "<script>alert"), 0u);
  const std::string escaped =
      "&lt;/script&gt;&lt;!--&lt;script&gt;alert(1)&lt;/script&gt; {{data}} &amp; &quot;q&quot;";
  // title twice, experiment, sentence, question, finding, command; version in the head twice and at the end
  EXPECT_EQ(count(page, escaped), 10u);
  const auto data = data_of(page);
  EXPECT_EQ(data["charts"][0]["title"], bad);
  EXPECT_EQ(data["charts"][0]["series"][0]["name"], bad);
  EXPECT_EQ(data["figures"][0]["source"], bad);
}

TEST(ExperimentReport, LoadsNothingAndLeavesNoMarker) {
  auto page = experiment_report_html(synthetic_experiment());
  EXPECT_NE(page.find("Copyright (c) 2021 Plotly, Inc"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  const auto own = without_chart_library(page);
  const std::regex loading(R"(\bsrc\s*=|<link\b|@import|url\(|https?://(?!www\.w3\.org/2000/svg))", std::regex::icase);
  std::smatch found;
  EXPECT_FALSE(std::regex_search(own, found, loading)) << found.str();
  EXPECT_FALSE(std::regex_search(own, found, std::regex(R"(\{\{\w+\}\})"))) << found.str();
}

TEST(ExperimentReport, DrawsALongSeriesFromThreeThousandPointsWithItsPeaks) {
  auto report = synthetic_experiment();
  auto& series = report.result.charts[0].series[0];
  series.x.clear(), series.y.clear();
  for (int i = 0; i < 100'000; ++i) {
    series.x.push_back(i * 1e-3);
    series.y.push_back(std::sin(i * 1e-3));
  }
  series.y[51'234] = 7.0;
  series.y[51'235] = -9.0;
  const auto data = data_of(experiment_report_html(report));
  const auto y = floats_of(data["charts"][0]["series"][0]["y"]);
  EXPECT_LE(y.size(), 3000u);
  EXPECT_GT(y.size(), 2500u);
  EXPECT_EQ(std::ranges::max(y), 7.0f);
  EXPECT_EQ(std::ranges::min(y), -9.0f);
}

TEST(ExperimentReport, RefusesASeriesOfUnequalLengths) {
  auto report = synthetic_experiment();
  report.result.charts[1].series[2].y.pop_back();
  EXPECT_THROW(experiment_report_html(report), std::invalid_argument);
}

TEST(ExperimentReport, OfAnEmptyResultIsAPage) {
  auto report = synthetic_experiment();
  report.result.charts.clear();
  report.result.figures.clear();
  report.result.findings.clear();
  EXPECT_EQ(data_of(experiment_report_html(report))["figures"].size(), 0u);
}

// ---- figures ----

TEST(FigureRows, PutTheModelsOfOneFigureTogetherWithTheSameDigits) {
  const auto rows = figure_rows(synthetic_experiment().result);
  ASSERT_EQ(rows.size(), 14u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rows[i].text, "peak deviation");
  EXPECT_EQ(rows[0].friction, "classical");
  EXPECT_EQ(rows[3].friction, "lugre");
  EXPECT_EQ(rows[3].value, "92.8");
  EXPECT_EQ(rows[3].expected, "93.0");
  EXPECT_EQ(rows[3].tolerance, "1.9");
  EXPECT_NEAR(*rows[3].offset, -0.2 / 1.9, 1e-9);
  EXPECT_EQ(rows[2].holds, false);
  EXPECT_EQ(rows[13].value, "0.8142");
  EXPECT_EQ(rows[13].friction, "");
  EXPECT_FALSE(rows[13].holds || rows[13].offset);
}

TEST(FigureRows, ShowWhatTheToleranceAndTheSourceResolve) {
  sim::ExperimentResult result;
  const auto printed = [&](double value, double expected, double tolerance) {
    result.figures = {{"f", "N", "force", value, sim::Expectation{expected, tolerance, "source"}}};
    const auto row = figure_rows(result).front();
    return row.value + " | " + row.expected + " +- " + row.tolerance;
  };
  EXPECT_EQ(printed(583.123, 578.6, 11.572), "583.1 | 578.6 +- 11.6");
  EXPECT_EQ(printed(1.17104, 1.171, 0.0005), "1.1710 | 1.1710 +- 0.0005");
  EXPECT_EQ(printed(1.0, 1.0, 0.0), "1 | 1 +- 0");
  EXPECT_EQ(printed(-1e-12, 0.0, 1.0), "0.0 | 0.0 +- 1.0");
  EXPECT_EQ(printed(81.3, 80.0, 5.0), "81 | 80 +- 5");
}

TEST(FigureRows, ShowFourDigitsWhereNothingIsExpected) {
  sim::ExperimentResult result;
  const auto printed = [&](double value, const char* unit = "N") {
    result.figures = {{"f", unit, "force", value, {}}};
    return figure_rows(result).front().value;
  };
  EXPECT_EQ(printed(0.0123456), "0.01235");
  EXPECT_EQ(printed(12345.6), "12346");
  EXPECT_EQ(printed(5.0), "5.000");
  EXPECT_EQ(printed(5.0, ""), "5");
  EXPECT_EQ(printed(1.5e-9), "1.500e-09");
  EXPECT_EQ(printed(0.0), "0");
  EXPECT_EQ(printed(std::nan("")), "nan");
}

TEST(Verdict, CountsAndNamesWhatDiffers) {
  auto result = synthetic_experiment().result;
  EXPECT_EQ(verdict(result), "12 of 13 figures are as expected; different: peak deviation (B2 parabolic).");
  for (auto& figure : result.figures) figure.value = figure.expected ? figure.expected->value : figure.value;
  EXPECT_EQ(verdict(result), "13 of 13 figures are as expected.");
  for (auto& figure : result.figures) figure.value = std::nan("");
  EXPECT_EQ(verdict(result), "0 of 13 figures are as expected.");
  for (auto& figure : result.figures) figure.expected.reset();
  EXPECT_EQ(verdict(result), "The machine file states no expected figures for this run.");
}

// ---- text ----

TEST(Typeset, SpellsUnitsSignsAndModels) {
  EXPECT_EQ(typeset("deviation, um"), "deviation, µm");
  EXPECT_EQ(typeset("maximum, column um; 3um"), "maximum, column µm; 3um");
  EXPECT_EQ(typeset("ramps to +-540 N"), "ramps to ±540 N");
  EXPECT_EQ(typeset("m/s^2"), "m/s²");
  EXPECT_EQ(typeset("us"), "µs");
  EXPECT_EQ(typeset("lugre: 12 um"), "C LuGre: 12 µm");
  EXPECT_EQ(typeset("gain 5, lugre"), "gain 5, C LuGre");
  EXPECT_EQ(typeset("a parabolic curve"), "a parabolic curve");
}

TEST(SplitModel, FindsAModelAtEitherEnd) {
  EXPECT_EQ(split_model("peak, linear_ramp").friction, "linear_ramp");
  EXPECT_EQ(split_model("peak, linear_ramp").text, "peak");
  EXPECT_EQ(split_model("lugre, 0.5 m/min").text, "0.5 m/min");
  EXPECT_EQ(split_model("lugre").text, "");
  EXPECT_EQ(split_model("classically, done").friction, "");
}

}  // namespace
}  // namespace stiction::host
