// Friction that drifts through a session: in records whose clocks begin anew, and in such whose clocks go on.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "tests/host/diagnose/dwelling_record.hpp"

namespace stiction::host {
namespace {

constexpr double change = -8.0, time_constant = 10.0, seconds = 6.0;

// Three records of 6 s, one behind the other, of a machine that warms up from the first on. With pauses (s) between
// them the clock goes on; without, each record has one of its own.
Verdict verdict_of_session(double pause) {
  DiagnoseInput input;
  input.machine = test::rigid_machine();
  input.closed_loop = input.next_measurement = false;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 5e-3);
  const std::vector<std::string> names{"first", "second", "third"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double began = (seconds + pause) * static_cast<double>(k);
    auto truth = input.machine;
    truth.axes.front().effects.push_back(
        {"thermal_drift", {{"change", {change}}, {"time_constant", {time_constant}}, {"elapsed", {began}}}});
    const std::vector set{test::dwelling(names[k], 30e-3, 0.4 - 0.05 * static_cast<double>(k))};
    auto record = without_noise(truth, 0, set).replayed.front();
    record.source = names[k];
    for (double& i : record.axes.front().i) i += noise(random);
    if (pause > 0.0)
      for (double& t : record.t) t += began;
    (k < 2 ? input.logs : input.held_out).push_back(record);
  }
  return diagnose(input);
}

void expect_drift(const Verdict& verdict, double end) {
  ASSERT_EQ(verdict.findings.size(), 1U);
  const auto found = verdict.findings.front().row();
  ASSERT_EQ(found.name, "thermal_drift");
  EXPECT_NEAR(found.values.at("change").front(), change, 0.1 * std::abs(change));
  EXPECT_NEAR(found.values.at("time_constant").front(), time_constant, 0.2 * time_constant);
  ASSERT_TRUE(found.values.contains("elapsed"));
  EXPECT_NEAR(found.values.at("elapsed").front(), end, 0.01);
}

}  // namespace

TEST(SessionOf, RecordsWithClocksThatBeginAnewTakesThemOneBehindTheOther) {
  expect_drift(verdict_of_session(0.0), 2.0 * seconds);
}

TEST(SessionOf, RecordsWithAClockThatGoesOnGoesByIt) { expect_drift(verdict_of_session(4.0), 2.0 * seconds + 4.0); }

}  // namespace stiction::host
