// A gap between the motor and the slide that has the friction, as in a nut.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "tests/host/diagnose/dwelling_record.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {

// How the mass is shared is not told, so the width is known to what that leaves open.
TEST(HeavyGap, IsNamedAndItsWidthIsWithinItsError) {
  constexpr double width = 5e-6;
  DiagnoseInput input;
  input.machine = test::rigid_machine();
  input.machine.axes.front().friction.use = "lugre";
  input.closed_loop = input.next_measurement = false;
  auto truth = input.machine;
  truth.axes.front().effects.push_back(
      {"backlash", {{"width", {width}}, {"mass_ratio", {0.6}}, {"frequency", {450.0}}}});
  const std::vector logs{test::dwelling("slow", 3e-3, 0.4), test::dwelling("quick", 8e-3, 0.3),
                         test::dwelling("other", 5e-3, 0.35)};
  const auto records = without_noise(truth, 0, logs).replayed;
  ASSERT_EQ(records.size(), logs.size());
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 5e-3);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    auto record = records[k];
    record.source = logs[k].source;
    for (double& i : record.axes.front().i) i += noise(random);
    (k < 2 ? input.logs : input.held_out).push_back(record);
  }
  const auto verdict = diagnose(input);
  ASSERT_FALSE(verdict.findings.empty());
  const auto& found = verdict.findings.front();
  ASSERT_EQ(found.effect.name(), "backlash");
  ASSERT_TRUE(found.row().values.contains("mass_ratio"));
  const double value = found.parameters.front().values.front(),
               error = found.parameters.front().standard_errors.front();
  test::figure("a gap of 5 um in front of a heavy slide",
               fmt::format("{:.2f} +- {:.2f} um; {:.3f} of the mass behind it", 1e6 * value, 1e6 * error,
                           found.row().values.at("mass_ratio")[0]));
  EXPECT_NEAR(value, width, 2.0 * error);
  EXPECT_LT(error, 0.5 * value);
}

}  // namespace stiction::host
