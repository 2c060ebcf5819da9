// An experiment's figures on standard output: keys, schema, text.
#include "host/output/experiment_output.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/host/report/synthetic_experiment.hpp"

namespace stiction::host {
namespace {

TEST(ExperimentJson, SpellsUnitsForKeys) {
  const auto key = [](const char* unit) { return figure_key({"f", unit, "", 0.0, {}}); };
  EXPECT_EQ(key("um"), "f_um");
  EXPECT_EQ(key("µm"), "f_um");
  EXPECT_EQ(key("N"), "f_N");
  EXPECT_EQ(key("m/min"), "f_m_per_min");
  EXPECT_EQ(key("N s/m"), "f_N_s_per_m");
  EXPECT_EQ(key("N·s/m"), "f_N_s_per_m");
  EXPECT_EQ(key("m/s^2"), "f_m_per_s2");
  EXPECT_EQ(key("%"), "f_percent");
  EXPECT_EQ(key(""), "f");
}

TEST(ExperimentJson, HasTheFormOfTheContract) {
  const auto report = synthetic_experiment();
  const auto json = experiment_json(report.result, report.machine);
  EXPECT_EQ(json["schema"], "stiction.impact/1");
  EXPECT_EQ(json["machine"], "mcfv5050ln");
  EXPECT_EQ(json["signals"], "fixed");
  EXPECT_EQ(json["results"].size(), report.result.figures.size());
  EXPECT_EQ(json["results"]["peak_deviation_lugre_um"], 92.8);
  EXPECT_EQ(json["results"]["settling_speed_m_per_min"], 0.8142);
  EXPECT_EQ(json["expected"]["peak_deviation_lugre_um"],
            (nlohmann::ordered_json{
                {"value", 93.0}, {"tolerance", 1.9}, {"source", "prototype (docs/prototype_figures.md, 3)"}}));
  EXPECT_FALSE(json["expected"].contains("settling_speed_m_per_min"));
  EXPECT_EQ(json["holds"].size(), 13u);
  EXPECT_EQ(json["holds"]["peak_deviation_lugre_um"], true);
  EXPECT_EQ(json["holds"]["peak_deviation_parabolic_um"], false);
  EXPECT_EQ(json["findings"], report.result.findings);
}

TEST(ExperimentJson, OfNoFiguresHasEmptyObjects) {
  auto report = synthetic_experiment();
  report.result.figures.clear();
  report.result.signals.clear();
  const auto json = experiment_json(report.result, report.machine);
  EXPECT_EQ(json["results"].dump(), "{}");
  EXPECT_EQ(json["expected"].dump(), "{}");
  EXPECT_FALSE(json.contains("signals"));
}

TEST(ExperimentJson, RefusesTwoFiguresOfOneKey) {
  auto report = synthetic_experiment();
  report.result.figures.push_back(report.result.figures.front());
  EXPECT_THROW(experiment_json(report.result, report.machine), std::invalid_argument);
}

TEST(ExperimentText, ShowsValuesBesideExpectationsAndSources) {
  const auto report = synthetic_experiment();
  const auto text = experiment_text(report.result, report.machine);
  EXPECT_TRUE(text.starts_with("Impact compliance, MCFV 5050 LN cross table, fixed signals\n")) << text;
  EXPECT_NE(text.find("parabolic      96.2 um         93.0 +- 1.9 [1]      DIFFERS"), std::string::npos) << text;
  EXPECT_NE(text.find("\n[1] prototype (docs/prototype_figures.md, 3)\n[2] prototype: 62 to 63 um\n"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("\n12 of 13 figures are as expected; different: peak deviation (B2 parabolic).\n"))
      << text;
}

}  // namespace
}  // namespace stiction::host
