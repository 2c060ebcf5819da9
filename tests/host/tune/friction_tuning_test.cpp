// Parameters of the compensation from logs of a machine whose friction is known, and what the timing rule says.
#include "host/tune/friction_tuning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "host/simulate/log_recorder.hpp"
#include "host/simulate/quadrant_run.hpp"
#include "host/tune/timing_rule.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::host {
namespace {

using test::figure;

machine::Machine machine_with(const std::string& friction) {
  return test::cross_table(
      {"axis.*.friction.use=" + friction, "axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=2 nm"});
}

Log log_of(const machine::Machine& machine, double feed, int laps = 2) {
  const auto one = one_axis(machine, 0);
  LogRecorder recorder(one);
  sim::CircleSettings circle;
  circle.feed = feed / 60.0;
  run_quadrants(machine, 0, circle, laps, recorder.sink<FixedSignals>());
  auto log = recorder.take();
  log.source = "circle.csv";
  return log;
}

FrictionTuning tuned(const machine::Machine& machine) {
  return tune_friction({log_of(machine, 8.0, 1), log_of(machine, 48.0)}, machine.axes[0]);
}

TEST(FrictionTuning, finds_level_mass_and_sliding_curve_of_maxwell_slip) {
  const auto machine = machine_with("maxwell_slip");
  const auto t = tuned(machine);
  const double constant = machine.axes[0].motor.force_constant;
  figure("tuning: Coulomb level, true 90 N", fmt::format("{:.2f} N (bound 3 %)", t.coulomb * constant));
  // The longest elements of the fit can take a part of what the sliding curve has at low speed.
  EXPECT_NEAR(t.coulomb * constant, 90.0, 2.7);
  EXPECT_NEAR(t.mass, 225.0, 0.005 * 225.0);  // the encoder's rider is half a kilogram more
  EXPECT_EQ(t.friction.contact_damping, 0.0);
  for (const double v : {0.05, 0.2, 0.7})
    for (const auto* list : {&t.friction.forward, &t.friction.backward})
      EXPECT_NEAR(t.coulomb + machine::sliding_value(t.friction.speed, *list, v), (90.0 + 500.0 * v) / constant, 0.03)
          << v;
}

TEST(FrictionTuning, finds_the_damping_of_a_lugre_contact) {
  const auto machine = machine_with("lugre");
  const auto t = tuned(machine);
  // b_s / k_s = 2 zeta sqrt(m / k_s) = 3.35 ms, of a grid of 0.25 ms.
  EXPECT_NEAR(t.friction.contact_damping, 3.35e-3, 0.3e-3);
  EXPECT_LE(t.friction.distance.size(), 8u);
}

TEST(FrictionTuning, says_what_is_missing_in_a_log) {
  const auto machine = machine_with("lugre");
  auto log = log_of(machine, 48.0, 1);
  log.axes[0].i.clear();
  EXPECT_THROW(tune_friction({log}, machine.axes[0]), LogError);
  log = log_of(machine, 48.0, 1);
  for (double& x : log.axes[0].x) x *= 1e-3;
  try {
    tune_friction({log}, machine.axes[0]);
    FAIL() << "accepted";
  } catch (const LogError& error) {
    EXPECT_STREQ(error.what(),
                 "circle.csv: found a motion over less than 1.8 mm; expected one that slides beyond the presliding "
                 "range, such as a circle");
  }
}

TEST(TimingRule, tells_too_early_from_too_late) {
  auto machine = machine_with("maxwell_slip");
  const auto t = tuned(machine);
  machine.timing.set_point_delay = 10 * machine.timing.fast_period;
  auto& compensation = machine.axes[0].friction_compensation.emplace();
  compensation.use = CompensationKind::friction;
  compensation.friction = t.friction;
  std::vector<double> late;
  for (const double ahead : {0.0, 200e-6, 500e-6}) {
    compensation.friction->look_ahead = ahead;
    late.push_back(timing_of(log_of(machine, 16.0, 3), machine, 0).late);
  }
  figure("timing rule, look-ahead 0, 200, 500 us: late by",
         fmt::format("{:.0f}, {:.0f}, {:.0f} us", late[0] * 1e6, late[1] * 1e6, late[2] * 1e6));
  EXPECT_GT(late[0], 80e-6);
  EXPECT_LT(late[2], -80e-6);
  EXPECT_LT(std::abs(late[1]), 60e-6);
}

TEST(TimingRule, verdict_takes_the_scatter_into_account) {
  EXPECT_EQ((TimingError{30e-6, 20e-6, 8}).verdict(62.5e-6), "in time");
  EXPECT_EQ((TimingError{90e-6, 20e-6, 8}).verdict(62.5e-6), "too late");
  EXPECT_EQ((TimingError{-90e-6, 20e-6, 8}).verdict(62.5e-6), "too early");
}

}  // namespace
}  // namespace stiction::host
