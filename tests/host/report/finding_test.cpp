// The sentence at the head of each kind of report, and what the head says of the report's sources.
#include <gtest/gtest.h>

#include <cstdlib>

#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/report/diagnosis_finding.hpp"
#include "host/report/experiment_finding.hpp"
#include "host/report/identification_finding.hpp"
#include "host/report/next_measurement_section.hpp"
#include "host/report/origin.hpp"
#include "tests/host/report/synthetic_circle.hpp"
#include "tests/host/report/synthetic_diagnosis.hpp"

namespace stiction::host {
namespace {

sim::ExperimentResult experiment(const char* name, std::vector<sim::Figure> figures) {
  sim::ExperimentResult result;
  result.experiment = name;
  result.figures = std::move(figures);
  return result;
}

std::string sentence_of(const sim::ExperimentResult& result) {
  return experiment_sentence(result, synthetic_circle().machine);
}

// ---- experiments ----

TEST(ExperimentSentence, OfATuningNamesTheWorstCircleAndTheBestCompensation) {
  const auto result = experiment(
      "tune-friction",
      {{"peak_error_X_off_8_m_per_min", "um", "largest error, X at 8 m/min, without compensation", 4.3, {}},
       {"peak_error_X_friction_8_m_per_min", "um", "largest error, X at 8 m/min, with friction", 0.5, {}},
       {"peak_error_X_off_48_m_per_min", "um", "largest error, X at 48 m/min, without compensation", 16.1, {}},
       {"peak_error_X_pulse_48_m_per_min", "um", "largest error, X at 48 m/min, with pulses", 12.3, {}},
       {"peak_error_X_friction_48_m_per_min", "um", "largest error, X at 48 m/min, with friction", 0.43, {}}});
  EXPECT_EQ(sentence_of(result), "16.1 → 0.43 µm at reversals: the largest error, X at 48 m/min with friction.");
}

TEST(ExperimentSentence, OfATuningThatGainsNothingSaysSo) {
  const auto result =
      experiment("tune-friction",
                 {{"peak_error_X_off_8_m_per_min", "um", "largest error, X at 8 m/min, without compensation", 4.3, {}},
                  {"peak_error_X_friction_8_m_per_min", "um", "largest error, X at 8 m/min, with friction", 4.4, {}}});
  EXPECT_EQ(sentence_of(result), "No kind of compensation lowers the largest error, X at 8 m/min of 4.3 µm.");
}

TEST(ExperimentSentence, OfTwoMachinesSaysWhatTheSecondGains) {
  const auto result =
      experiment("replay", {{"position_difference_rms_X_machine", "um", "position, rms of X, machine", 0.42, {}},
                            {"position_difference_rms_X_extended", "um", "position, rms of X, extended", 0.25, {}}});
  EXPECT_EQ(sentence_of(result),
            "The deviation of the simulated position from the record falls from 0.42 µm rms (machine) to 0.25 µm rms "
            "(extended).");
}

TEST(ExperimentSentence, EndsWithTheFiguresThatWereExpected) {
  const auto result = experiment(
      "friction-lag", {{"width_at_10_rad_per_s", "N", "width at 10 rad/s", 66.7, sim::Expectation{80.0, 1.0, "s"}}});
  EXPECT_EQ(sentence_of(result),
            "The friction lags behind the speed by a loop of up to 66.7 N; 0 of 1 figures are as expected; different: "
            "width at 10 rad/s.");
}

TEST(ExperimentSentence, OfAnUnknownExperimentIsItsFirstFinding) {
  auto result = experiment("new", {});
  EXPECT_EQ(sentence_of(result), "The run has no figures.");
  result.findings = {"It moved by 3 um. It came back.", "And more."};
  EXPECT_EQ(sentence_of(result), "It moved by 3 µm.");
}

// ---- diagnosis ----

// Of several axes each has files of its own, and its page names those.
TEST(NextMeasurementSection, NamesTheFilesOfItsAxis) {
  for (auto make : {synthetic_diagnosis, synthetic_cam_proposal}) {
    const auto next = make().verdict.next;
    ASSERT_TRUE(next);
    const auto alone = next_measurement_json(next, "").dump(), of_axis = next_measurement_json(next, "Y").dump();
    const std::string file = next->cam ? next_measurement_cam_of("") : next_measurement_file_of("");
    const std::string file_of_axis = next->cam ? next_measurement_cam_of("Y") : next_measurement_file_of("Y");
    EXPECT_NE(alone.find(file), std::string::npos);
    EXPECT_NE(of_axis.find(file_of_axis), std::string::npos);
    EXPECT_EQ(of_axis.find(file), std::string::npos);
  }
}

TEST(DiagnosisSentence, NamesTheCausesAndWhatTheyAreWorthOnHeldOutData) {
  const auto text = diagnosis_sentence(synthetic_diagnosis().verdict);
  EXPECT_NE(text.find("constant force (X)"), std::string::npos) << text;
  EXPECT_NE(text.find("0.61 → 0.22 µm rms of position error, 3.42 → 1.18 N rms of force."), std::string::npos) << text;
}

TEST(DiagnosisSentence, SaysThatTheResidualDoesNotFall) {
  auto verdict = synthetic_diagnosis().verdict;
  verdict.extended = verdict.baseline;
  EXPECT_TRUE(
      diagnosis_sentence(verdict).ends_with("but on held-out data the residual force does not fall (3.42 N rms)."))
      << diagnosis_sentence(verdict);
}

// The figures of the synthetic record: 1.2 N where noise leaves 1.08 N, 0.3 um where it leaves 0.2 um.
TEST(DiagnosisSentence, TellsAgreementFromAResidualWithoutAKnownCause) {
  auto verdict = synthetic_agreement().verdict;
  EXPECT_EQ(diagnosis_sentence(verdict),
            "The simulation agrees with the data within their noise: 1.2 N rms of residual force where noise "
            "alone leaves 1.08 N; 0.3 µm rms of position error where noise alone leaves 0.2 µm.");
  const auto with = [&](const Remainder& rest, const std::string& withheld = "") {
    verdict.agreement = agreement_of(rest, withheld, {});
    return diagnosis_sentence(verdict);
  };
  EXPECT_EQ(with({5.0, 0.3e-6, 1.08, 0.2e-6, 50.0, true}),
            "Simulation and machine do not agree, and no known cause explains the difference: 5 N rms of residual "
            "force where noise alone leaves 1.08 N.");
  // What repeats with nothing disturbs the axis, and moves it.
  const auto disturbed = with({5.0, 0.9e-6, 1.08, 0.2e-6, 50.0, false, 0.6e-6});
  EXPECT_TRUE(disturbed.starts_with("The simulation agrees with the data within their noise")) << disturbed;
  EXPECT_NE(disturbed.find("the rest, 10 % of the force, repeats with nothing"), std::string::npos) << disturbed;
  EXPECT_TRUE(with({5.0, 0.9e-6, 1.08, 0.2e-6, 50.0, false, 0.3e-6}).starts_with("Simulation and machine do not"));
  // But not as much as 46 % of the force.
  EXPECT_TRUE(with({23.0, 0.3e-6, 1.08, 0.2e-6, 50.0}).starts_with("Simulation and machine do not agree"));
  EXPECT_TRUE(with({1.2, 3e-6, 1.08, 0.2e-6, 50.0}).starts_with("Simulation and machine do not agree"));
  // A floor of 46 % of the force.
  EXPECT_TRUE(
      with({23.0, 0.3e-6, 23.0, 0.2e-6, 50.0})
          .starts_with("These records cannot tell whether simulation and machine agree: noise alone leaves 23 N rms of "
                       "these records unexplained, whose force is 50 N rms"));
  EXPECT_TRUE(with({1.2, {}, 1.08, 0.2e-6, 50.0}).starts_with("These records cannot tell"));
  EXPECT_NE(with({1.2, {}, 1.08, 0.2e-6, 50.0}, "run.csv: found u_inject[V]").find("found u_inject[V]"),
            std::string::npos);
  verdict.agreement.reset();
  EXPECT_TRUE(diagnosis_sentence(verdict).starts_with("No cause was found for the residual of 1.2 N rms"));
  verdict.unexplained.signature = "grows with acceleration";
  EXPECT_EQ(
      diagnosis_sentence(verdict),
      "Simulation and machine do not agree: no known cause explains the residual of 1.2 N rms, 0.3 µm rms of position "
      "error; its pattern: grows with acceleration.");
}

// ---- identification ----

TEST(IdentificationSentence, GivesFrictionAndMassWithTheirIntervals) {
  Identification result;
  result.axis = "X";
  EXPECT_EQ(identification_sentence(result), "None of the 0 parameters of axis X is determined by these records.");
  result.parameters = {{"coulomb_N", 94.12, {93.72, 94.52}, ""}, {"mass_kg", 225.6, {224.1, 227.1}, ""}};
  result.not_determined = {{"damping_ratio", "", ""}};
  result.force_rms = 200.0;
  result.residual_rms = 5.0;
  EXPECT_EQ(
      identification_sentence(result),
      "Axis X has a Coulomb friction of 94.12 ± 0.40 N and a moving mass of 225.6 ± 1.5 kg (2 of 3 parameters are "
      "determined); the fit leaves 5 of 200 N rms, 2.5 % of the force.");
}

TEST(IdentificationSentence, NamesTheValuesOfTheMachineFileBesideThem) {
  Identification result;
  result.axis = "X";
  result.parameters = {{"coulomb_N", 94.12, {93.72, 94.52}, ""}, {"mass_kg", 225.6, {224.1, 227.1}, ""}};
  machine::AxisModel file;
  file.mass = 90.0;
  EXPECT_EQ(identification_sentence(result, &file),
            "Axis X has a Coulomb friction of 94.12 ± 0.40 N and a moving mass of 225.6 ± 1.5 kg (machine file: 90).");
}

// ---- origin ----

TEST(Origin, SaysWhatTheLogsCanDetermineBeforeAnyResult) {
  Origin origin;
  EXPECT_EQ(abilities_html(origin), "");
  origin.sources = {"run.csv"};
  origin.abilities = {{"X",
                       {"Moving mass", "Constant force"},
                       {{"Stribeck <effect>", "no speed below 1 mm/s", "slow passes"}},
                       {"the current is that of the other axis"}}};
  const auto html = abilities_html(origin);
  for (const char* part : {"<strong>Check first of axis X:</strong> the current is that of the other axis.",
                           "<strong>This log can determine of axis X:</strong> moving mass, constant force.",
                           "<strong>Cannot determine of axis X:</strong> stribeck &lt;effect&gt;</summary>",
                           "no speed below 1 mm/s; record slow passes."})
    EXPECT_NE(html.find(part), std::string::npos) << part << "\n" << html;
  origin.sources.push_back("other.csv");
  EXPECT_NE(abilities_html(origin).find("These logs can determine"), std::string::npos);
}

TEST(Origin, NamesFilesWithoutTheirFoldersAndEscapesThem) {
  const auto html = origin_html({{"/a/m.toml"}, {"/a/<run>.csv", "b.csv"}, {1e-3, 62.5e-6, 1e-3}, "2026-11-23"},
                                "M & N", "stiction diagnose '<run>.csv'", "0.1.0");
  for (const char* part :
       {"<dd>2026-11-23</dd>", "<dd>M &amp; N</dd>", "<dd>m.toml</dd>", "<dd>&lt;run&gt;.csv, b.csv</dd>",
        "<dd>1 kHz (1000 µs), 16 kHz (62.5 µs)</dd>", "stiction diagnose &#39;&lt;run&gt;.csv&#39;"})
    EXPECT_NE(html.find(part), std::string::npos) << part << " in " << html;
  EXPECT_NE(origin_html({}, "M", "c", "v").find("none: a simulation"), std::string::npos);
}

TEST(Origin, TakesTheDateOfAReproducibleBuild) {
  ::setenv("SOURCE_DATE_EPOCH", "0", 1);
  EXPECT_EQ(present_date(), "1970-01-01 00:00 UTC");
  ::unsetenv("SOURCE_DATE_EPOCH");
}

// What explains least of the force here moves the axis most.
TEST(DiagnosisReport, TellsFirstWhatMovesTheAxisMostAndWhatIsSmall) {
  auto verdict = synthetic_diagnosis().verdict;
  ASSERT_EQ(verdict.findings.size(), 2u);
  verdict.findings[1].part_error = 2.0 * *verdict.findings[0].part_error;
  EXPECT_EQ(told_by_position(verdict.findings), (std::vector<std::size_t>{1, 0}));
  EXPECT_FALSE(verdict.is_small(verdict.findings[0]));
  verdict.small_below = 1.5 * *verdict.findings[0].part_error;
  EXPECT_TRUE(verdict.is_small(verdict.findings[0]));
  EXPECT_FALSE(verdict.is_small(verdict.findings[1]));
  for (auto& finding : verdict.findings) finding.part_error.reset();
  EXPECT_EQ(told_by_position(verdict.findings), (std::vector<std::size_t>{0, 1}));
  EXPECT_FALSE(verdict.is_small(verdict.findings[0]));
}

}  // namespace
}  // namespace stiction::host
