// Records that cannot tell two causes apart; the proposed trajectory is then run with the hidden effect, and the
// diagnosis of both names the right one alone.
#include "host/diagnose/next_measurement/next_measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/log/csv_log.hpp"
#include "host/simulate/commissioning.hpp"
#include "host/simulate/replay.hpp"
#include "sim/experiment/commissioning_path.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// As the demonstration has it.
machine::Machine machine() {
  return sim::read_machine(
      std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
      {{}, {"axis.X.encoder.velocity=estimated", "axis.X.encoder.noise=2 nm", "axis.X.motor.force_constant=94.2 N/A"}});
}

host::Log set_points(const char* name, const sim::Trajectory& path) {
  host::Log log;
  log.source = name;
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  axis.axis = "X";
  for (int k = 0; k * log.period < path.duration; ++k) {
    const auto point = path.at(k * log.period);
    log.t.push_back(k * log.period);
    axis.x_set.push_back(point.position);
    axis.v_set.push_back(point.velocity);
    axis.a_set.push_back(point.acceleration);
  }
  axis.x = axis.x_set;
  return log;
}

host::Log recorded(const machine::Machine& real, const host::Log& wanted, std::uint64_t seed) {
  return host::record_set_points(real, 0, wanted, seed);
}

std::string findings_of(const host::Verdict& verdict) {
  std::string all;
  for (const auto& finding : verdict.findings) {
    all += (all.empty() ? "" : ", ") + finding.effect.name();
    for (const auto& other : finding.confused_with) all += " or " + other.effect.name();
  }
  return all.empty() ? "nothing" : all;
}

bool says(const host::Verdict& verdict, const std::string& effect, const std::string& rival) {
  return std::any_of(verdict.findings.begin(), verdict.findings.end(), [&](const host::Finding& f) {
    const auto confused = [&](const std::string& with) {
      return std::any_of(f.confused_with.begin(), f.confused_with.end(),
                         [&](const auto& c) { return c.effect.name() == with; });
    };
    return (f.effect.name() == effect && confused(rival)) || (f.effect.name() == rival && confused(effect));
  });
}

struct Case {
  const char* name;
  machine::Effect hidden;
  std::string rival;
  sim::Trajectory training, held_out;
};

// Hidden effects that these records show, but not so well that they tell them from the rival.
std::vector<Case> cases() {
  const auto speeds = [](const std::vector<double>& v) { return sim::constant_speeds(v, 0.4, 2e-3); };
  return {{"few speeds",
           {"viscous_mismatch", {{"viscous", {530.0}}}},
           "viscous_nonlinear",
           speeds({0.1, 0.2, 0.15}),
           speeds({0.12, 0.17})},
          {"two speeds",
           {"friction_lag", {{"time", {0.005}}}},
           "mass_mismatch",
           speeds({0.3, 0.25}),
           speeds({0.28, 0.22})}};
}

// Contact of the file's own shape: stiffness times distance is ln 10 times the Coulomb level.
TEST(NextMeasurement, is_not_asked_for_what_few_reversals_show) {
  host::DiagnoseInput input;
  input.machine = machine();
  input.closed_loop = false;
  auto real = input.machine;
  real.axes.front().effects = {
      {"presliding_hysteresis", {{"stiffness", {90.0 * std::numbers::ln10 / 300e-6}}, {"distance", {300e-6}}}}};
  const auto few = [](const std::vector<double>& v) { return sim::constant_speeds(v, 0.4, 2e-3); };
  input.logs = {recorded(real, set_points("training", few({0.3, 0.25})), 1)};
  input.held_out = {recorded(real, set_points("held out", few({0.28, 0.22})), 2)};
  const auto verdict = host::diagnose(input);
  ASSERT_EQ(findings_of(verdict), "presliding_hysteresis");
  EXPECT_NEAR(verdict.findings.front().values.at("distance").front(), 300e-6, 30e-6);
}

class EachAmbiguity : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EachAmbiguity, is_settled_by_the_proposed_record) {
  const auto c = cases()[GetParam()];
  host::DiagnoseInput input;
  input.machine = machine();
  input.closed_loop = false;
  auto real = input.machine;
  real.axes.front().effects = {c.hidden};
  input.logs = {recorded(real, set_points("training", c.training), 1)};
  input.held_out = {recorded(real, set_points("held out", c.held_out), 2)};
  const auto before = host::diagnose(input);
  EXPECT_TRUE(says(before, c.hidden.name, c.rival)) << findings_of(before);
  ASSERT_TRUE(before.next.has_value() && before.next->log.has_value()) << findings_of(before);
  const auto& best = before.next->trajectories.front();
  // What it promises for the question it is asked: enough to be named, and more than the records have.
  EXPECT_GT(best.separations.front(), 5.0);
  EXPECT_GT(best.separations.front(), 2.0 * before.next->questions.front().these_logs);

  // As a user gets it: a file that `simulate replay --from` reads and runs.
  const auto as_file = host::parse_csv_log(host::csv_log_text(*before.next->log), "next_measurement.csv");
  const auto run = host::replay<FixedSignals>(input.machine, as_file);
  EXPECT_EQ(run.axes.front().x.size(), as_file.t.size());
  const auto json = host::verdict_json(before)["next_measurement"];
  EXPECT_EQ(json["log"], "next_measurement.csv");
  EXPECT_EQ(json["questions"].size(), json["trajectories"][0]["standard_errors"].size());

  input.logs.push_back(recorded(real, as_file, 3));
  const auto after = host::diagnose(input);
  figure(fmt::format("next measurement, {} hidden, {}", c.hidden.name, c.name),
         fmt::format("{}; {} proposed, {:.1f} standard errors expected (present logs {:.1f}); with it: {}",
                     findings_of(before), best.name, best.separations.front(),
                     before.next->questions.front().these_logs, findings_of(after)));
  ASSERT_FALSE(after.findings.empty());
  EXPECT_EQ(after.findings.front().effect.name(), c.hidden.name);
  EXPECT_FALSE(says(after, c.hidden.name, c.rival)) << findings_of(after);
}

INSTANTIATE_TEST_SUITE_P(NextMeasurement, EachAmbiguity, ::testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& each) {
                           std::string name = cases()[each.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// No motion of one axis tells a constant force from an asymmetry: it says so, with the experiment that does.
TEST(NextMeasurement, proposes_no_motion_where_none_can_tell) {
  host::DiagnoseInput input;
  input.machine = machine();
  input.closed_loop = false;
  auto real = input.machine;
  real.axes.front().effects = {{"constant_force", {{"force", {12.0}}}}};
  input.logs = {recorded(real, set_points("training", sim::constant_speeds({0.02, 0.1, 0.2, 0.05}, 0.5, 2e-3)), 1)};
  input.held_out = {recorded(real, set_points("held out", sim::constant_speeds({0.03, 0.07, 0.15}, 0.5, 2e-3)), 2)};
  const auto verdict = host::diagnose(input);
  ASSERT_TRUE(verdict.next.has_value()) << findings_of(verdict);
  const auto& question = verdict.next->questions.front();
  EXPECT_EQ(question.effect.name(), "constant_force");
  EXPECT_EQ(question.rival, sim::find_effect("friction_asymmetry"));
  EXPECT_FALSE(question.by_motion);
  EXPECT_NE(question.separate_by.find("the axis turned over"), std::string::npos);
  EXPECT_TRUE(host::verdict_json(verdict)["next_measurement"]["log"].is_null() || verdict.next->questions.size() > 1);
}

}  // namespace
}  // namespace stiction::test
