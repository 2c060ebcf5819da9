// B2's chatter is of the step, and the break-away force of the dynamic model falls with the rate of the force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/simulate/experiments.hpp"
#include "host/simulate/parabolic_chatter.hpp"
#include "sim/plant/friction/parabolic.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

machine::Machine machine_for(const char* experiment) {
  auto machine = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                                   {experiment, {}});
  machine.axes.resize(1);
  return machine;
}

host::ChatterRun impact(std::optional<double> step) {
  return host::impact_with_parabolic_friction(machine_for("impact"), 1500.0, 0.01, step);
}

TEST(ParabolicFriction, ChattersWhenEvaluatedExplicitlyAtACoarseStep) {
  const auto machine = machine_for("impact");
  const auto& p = sim::parameters_of<sim::Parabolic<>>(machine.axes[0].friction);
  for (const double step : {200e-6, 400e-6}) {
    const auto run = impact(step);
    const double amplitude = host::chatter_amplitude(p, machine.axes[0].mass, step);
    figure(fmt::format("B2 after the impact, explicit every {:g} ms", step * 1e3),
           fmt::format("{:.1f} to {:+.1f} N, rms {:.2f} N (formula {:.2f} N within 2 %), alternating {:.0f} %",
                       run.least, run.greatest, run.rms, amplitude, run.alternating * 100));
    EXPECT_NEAR(run.rms, amplitude, 0.02 * amplitude) << step;
    EXPECT_GT(run.alternating, 0.95);
  }
}

TEST(ParabolicFriction, DoesNotChatterAtTheTickOrWithTheImplicitStep) {
  const auto tick = impact(62.5e-6), implicit = impact({});
  figure("B2 after the impact, friction changing its sign between evaluations",
         fmt::format("explicit 62.5 us {:.1f} %, implicit {:.2f} % (bound 5 %)", tick.alternating * 100,
                     implicit.alternating * 100));
  // The hunting of the 1 um quantizer turns the carriage now and then.
  EXPECT_LT(tick.alternating, 0.05);
  EXPECT_LT(implicit.alternating, 0.05);
}

TEST(BreakAway, FallsWithTheRateOfTheForceAsThePrototypeFound) {
  const auto experiments = host::experiments();
  const auto break_away = std::find_if(experiments.begin(), experiments.end(),
                                       [](const auto& each) { return each.run == host::run_break_away; });
  const auto result = host::run_experiment(*break_away, {machine_for("break-away"), {"lugre"}});
  std::string found;
  int count = 0;
  for (const auto& f : result.figures) {
    if (!f.expected) continue;
    ++count;
    EXPECT_NEAR(f.value, f.expected->value, 0.002 * f.expected->value) << f.name;
    found += fmt::format("{:.1f} ", f.value);
  }
  EXPECT_EQ(count, 4);
  figure("break-away at 10, 1e3, 3e3, 1e4 N/s", found + "N (578.6, 551.5, 504.9, 415.3 N within 2 %)");
}

}  // namespace
}  // namespace stiction::test
