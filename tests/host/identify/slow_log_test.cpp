// Logs as a PLC or a fieldbus writes them, 10 to 190 Hz: the force must be filtered as the motion is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/identify/identification.hpp"
#include "tests/host/identify/campaign.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

class SlowLog : public ::testing::TestWithParam<double> {};

// Before the force was filtered as the position is, Coulomb friction came out of a log of 100 Hz as a negative number
// and the user was told that his sign was swapped.
TEST_P(SlowLog, has_the_friction_and_the_mass_of_a_fast_one) {
  const double period = GetParam();
  const auto machine = bench_machine("lugre");
  std::vector<host::Log> logs;
  for (const auto& trajectory :
       {constant_speeds({0.005, 0.01, 0.02, 0.05, 0.1, 0.2}, 1.0, 0.0), circle(6.0 / 60.0, 1.0)})
    logs.push_back(with_noise(simulated(machine, trajectory, period), {}, 1));
  const auto result = host::identify_logs(logs, machine.axes.front(), {"lugre", host::Amperes::amplitude, {}});
  for (const auto& [name, share] : {std::pair{"mass_kg", 0.03}, {"coulomb_N", 0.03}, {"viscous_N_s_per_m", 0.05}}) {
    const auto* found = result.find(name);
    ASSERT_NE(found, nullptr) << name;
    const auto truths = truths_of(machine.axes.front());
    const auto truth = std::find_if(truths.begin(), truths.end(), [&](const auto& t) { return t.name == name; });
    const double off = found->value / truth->value - 1.0;
    figure(fmt::format("identification, log at {:.0f} Hz: {}", 1.0 / period, name),
           fmt::format("{:+.2f} % off (bound {:g} %)", 100.0 * off, 100.0 * share));
    EXPECT_LE(std::abs(off), share) << name;
  }
}
INSTANTIATE_TEST_SUITE_P(Rates, SlowLog, ::testing::Values(20e-3, 10e-3, 5.25e-3));

// Sines of a few increments of a coarse encoder: the rows' speed rises above the highest of the samples, and its place
// in the histogram of kept speeds was a negative number. The truth is Newton's law.
TEST(SlowLogs, sines_of_a_few_increments_are_answered) {
  const auto machine = bench_machine("coulomb_viscous");
  for (int frequency = 10; frequency < 80; ++frequency) {
    host::Log log;
    log.source = "sine";
    log.period = 10e-3;
    auto& axis = log.axes.emplace_back();
    const double w = 0.6 * frequency, mass = 78.0, viscous = 223.0, coulomb = 16.5;
    for (int k = 0; k < 1464; ++k) {
      const double t = k * log.period;
      log.t.push_back(t);
      axis.x.push_back(1e-4 * std::round(7e-4 * std::sin(w * t) / 1e-4));
      const double v = 7e-4 * w * std::cos(w * t);
      axis.force.push_back(-mass * 7e-4 * w * w * std::sin(w * t) + viscous * v + std::copysign(coulomb, v));
    }
    try {
      host::identify_logs({log}, machine.axes.front(), {"coulomb_viscous", host::Amperes::amplitude, {}, true});
    } catch (const host::LogError&) {
      // Said in a sentence.
    }
  }
}

}  // namespace
}  // namespace stiction::test
