// The figures of the friction compensation on two truth machines; compensation_proof has all of them.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/simulate/quadrant_run.hpp"
#include "tests/compensation/cases.hpp"
#include "tests/support/figure.hpp"

namespace stiction::compensation {
namespace {

TEST(Compensation, figures_hold_on_two_truths) {
  const Proof proof = run_proof(true);
  for (const auto& f : figures(proof)) {
    test::figure(f.text, f.value);
    EXPECT_TRUE(f.met) << f.text << ": " << f.value;
  }
}

// Of the LuGre machine, tuned, with a table that pushes the wrong way after every reversal.
TEST(Compensation, a_bad_learned_table_is_dropped_within_a_lap) {
  auto tuned = tune(truths()[1], 0, false);
  auto& compensation = *tuned.machine.axes[0].friction_compensation;
  compensation.learning->limit = 0.5;
  compensation.learning->gain = 0.0;
  compensation.learning->smoothing = compensation.learning->forgetting = 0.0;
  machine::LearnedTable table{tuned.machine.name, "X", std::vector<double>(learned_table_nodes, -0.45),
                              std::vector<double>(learned_table_nodes, 0.45)};
  compensation.learned = table;
  sim::CircleSettings circle;
  circle.feed = 16.0 * metre_per_minute;
  const auto run = host::run_quadrants(with_compensation(tuned, CompensationKind::learning), 0, circle, 6);
  const auto baseline = host::run_quadrants(with_compensation(tuned, CompensationKind::friction), 0, circle, 3);
  const double worst = *std::max_element(run.peak_error.begin(), run.peak_error.end());
  test::figure("bad learned table: worst lap, last lap, baseline",
               fmt::format("{:.2f}, {:.2f}, {:.2f} um", worst * 1e6, run.peak_error.back() * 1e6,
                           baseline.peak_error.back() * 1e6));
  EXPECT_TRUE(run.dropped);
  EXPECT_GT(worst, 2.0 * baseline.peak_error.back());
  // Of the six laps one has the table; the last two are the baseline's again, to the quantiser's hunting.
  EXPECT_LT(run.peak_error[4], baseline.peak_error.back() + 0.3e-6);
  EXPECT_LT(run.peak_error[5], baseline.peak_error.back() + 0.3e-6);
}

TEST(Compensation, learned_table_of_a_run_serves_the_next) {
  auto tuned = tune(truths()[0], 0, false);
  changes()[0].apply(tuned.machine.axes[0]);
  sim::CircleSettings circle;
  circle.feed = 24.0 * metre_per_minute;
  auto machine = with_compensation(tuned, CompensationKind::learning);
  const auto first = host::run_quadrants(machine, 0, circle, 6);
  machine.axes[0].friction_compensation->learned =
      machine::LearnedTable{machine.name, "X", first.learned_forward, first.learned_backward};
  const auto second = host::run_quadrants(machine, 0, circle, 3);
  EXPECT_FALSE(second.dropped);
  test::figure("kept learned table: silent first lap, first lap with it",
               fmt::format("{:.2f}, {:.2f} um", second.peak_error[1] * 1e6, second.peak_error[2] * 1e6));
  // The silent lap takes the reference; the next one plays what five laps taught, and need not begin anew: it is at the
  // 1 um of the learned laps but for the quantiser's hunting.
  EXPECT_LT(second.peak_error[2], 1.2e-6);
  EXPECT_LT(second.peak_error[2], 0.7 * *std::max_element(second.peak_error.begin(), second.peak_error.end()));
}

}  // namespace
}  // namespace stiction::compensation
