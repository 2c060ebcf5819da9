// Refinement in closed loop: what it gains where the position is coarse, and that it leaves a good fit alone.
#include "host/identify/refinement.hpp"

#include <gtest/gtest.h>

#include "tests/host/identify/campaign.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using host::Amperes;

struct Both {
  host::Identification fit;
  host::Refinement refined;
};

Both identified(const Noise& noise, std::uint64_t seed) {
  const auto machine = bench_machine("lugre");
  const auto& axis = machine.axes.front();
  std::vector<host::Log> logs;
  for (const auto& trajectory : commissioning())
    logs.push_back(with_noise(simulated(machine, trajectory), noise, seed++));
  const host::IdentifyOptions options{"lugre", Amperes::amplitude, {}};
  auto fit = host::identify_logs(logs, axis, options);
  auto refined = host::refine_in_closed_loop(logs, machine, axis, fit, options);
  return {std::move(fit), std::move(refined)};
}

double off(double value, double truth) { return std::abs(value / truth - 1.0); }

TEST(Refinement, takes_away_the_bias_of_a_coarse_position) {
  // Increments and noise of 1 um: 2 N of noise in mass times acceleration, and a contact that never rests.
  const auto both = identified({1e-6, 0.01}, 11);
  for (const auto& truth : truths_of(bench_machine("lugre").axes.front())) {
    const auto refined = std::find_if(both.refined.parameters.begin(), both.refined.parameters.end(),
                                      [&](const auto& p) { return p.name == truth.name; });
    if (refined == both.refined.parameters.end()) continue;
    const double before = off(both.fit.find(truth.name)->value, truth.value), after = off(refined->value, truth.value);
    figure("identification, 1 um encoder: " + truth.name,
           fmt::format("{:.2g} % off, {:.2g} % after refinement in closed loop", before * 100.0, after * 100.0));
  }
  const auto named = [&](const char* name) {
    return std::find_if(both.refined.parameters.begin(), both.refined.parameters.end(),
                        [&](const auto& p) { return p.name == name; })
        ->value;
  };
  EXPECT_LE(off(named("mass_kg"), 225.0), 0.01);
  EXPECT_LE(off(named("coulomb_N"), 90.0), 0.02);
  EXPECT_LE(off(named("viscous_N_s_per_m"), 500.0), 0.05);
  EXPECT_LE(off(named("stiffness_N_per_m"), 8e5), 0.1);
  EXPECT_LT(both.refined.force_after, both.refined.force_before);
}

TEST(Refinement, leaves_a_good_fit_within_its_intervals) {
  const auto both = identified({}, 21);
  for (const auto& refined : both.refined.parameters) {
    const auto ci = both.fit.find(refined.name)->ci95;
    // Twice the interval: both estimates scatter.
    const double half = ci.high - ci.low;
    EXPECT_NEAR(refined.value, both.fit.find(refined.name)->value, half) << refined.name;
  }
  EXPECT_LE(both.refined.force_after, both.refined.force_before * (1.0 + 1e-9));
}

}  // namespace
}  // namespace stiction::test
