#include "host/simulate/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/simulate/circle.hpp"
#include "host/simulate/replay_result.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::host {
namespace {

// A circle of the cross table at 16 m/min as a log of every `stride`-th tick.
Log circle_log(const machine::Machine& machine, std::int64_t stride, double from = 0.0) {
  Log log;
  log.source = "circle";
  log.period = static_cast<double>(stride) * machine.timing.fast_period;
  log.axes.resize(2);
  log.axes[0].axis = machine.axes[0].name;
  log.axes[1].axis = machine.axes[1].name;
  sim::CircleSettings settings;
  settings.radius = 0.09;
  settings.feed = 16.0 / 60.0;
  std::int64_t tick = 0;
  run_circle<FixedSignals>(machine, settings, [&](std::int64_t now_ns, std::span<const AxisSignals<FixedSignals>> all) {
    const double t = static_cast<double>(now_ns) * 1e-9;
    if (tick++ % stride != 0 || t < from) return;
    log.t.push_back(t);
    for (std::size_t k = 0; k < 2; ++k) {
      auto& axis = log.axes[k];
      axis.x_set.push_back(machine::to_si(all[k].x_set));
      axis.v_set.push_back(machine::to_si(all[k].v_set));
      axis.a_set.push_back(machine::to_si(all[k].a_set));
      axis.x.push_back(machine::to_si(all[k].x));
      axis.v.push_back(machine::to_si(all[k].v));
      axis.i.push_back(machine::to_si(all[k].i));
    }
  });
  return log;
}

double greatest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

// The start is the first set position as the drive's format rounds it (58 pm), not the path's own: now and then that
// tips the encoder's reading by its 1 nm.
TEST(Replay, OfTheFullRateRepeatsTheRunToAnIncrementOfTheEncoder) {
  const auto machine = test::cross_table();
  const auto log = circle_log(machine, 1);
  const auto again = replay<FixedSignals>(machine, log);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(again.axes[k].x_set, log.axes[k].x_set);
    EXPECT_EQ(again.axes[k].v_set, log.axes[k].v_set);
    EXPECT_EQ(again.axes[k].a_set, log.axes[k].a_set);
    EXPECT_LE(greatest(again.axes[k].x, log.axes[k].x), 1.01e-9);
    EXPECT_LE(greatest(again.axes[k].i, log.axes[k].i), 1e-2);
  }
}

// Set-points interpolated between samples of 1 ms left 0.2 to 0.6 N.
TEST(Replay, OfOneKilohertzFollowsTheRun) {
  const auto machine = test::cross_table();
  auto log = circle_log(machine, 16);
  const auto with_all = replay<FixedSignals>(machine, log);
  for (auto& axis : log.axes) axis.v_set.clear(), axis.a_set.clear();
  const auto derived = replay<FixedSignals>(machine, log);
  for (const auto& [name, again] : {std::pair{"x, v and a logged", &with_all}, std::pair{"x logged", &derived}}) {
    const auto d = compare_replay(log, *again, 0, 0.0);
    const double force = d.effort * machine.axes[0].motor.force_constant;
    test::figure(
        fmt::format("replay from 1 kHz, {}", name),
        fmt::format("force {:.2f} N rms, position {:.4f} um rms off (bounds 0.6 N, 0.05 um)", force, d.position * 1e6));
    EXPECT_LE(force, 0.6);
    EXPECT_LE(d.position, 0.05e-6);
  }
}

// A log cut out of a motion: the machine is brought to its speed first. What the position controller's own dying-out
// leaves after 0.1 s is e^-8 of its start.
TEST(Replay, OfALogThatBeginsInMotionIsBroughtThere) {
  const auto machine = test::cross_table();
  const auto log = circle_log(machine, 16, 1.2345);
  const auto again = replay<FixedSignals>(machine, log);
  const auto d = compare_replay(log, again, 0, 0.0);
  EXPECT_LT(d.position, 0.3e-6);
  EXPECT_LT(d.effort, 0.05);
}

TEST(Replay, InDoublePrecisionIsNearTheFixedOne) {
  const auto machine = test::cross_table();
  const auto log = circle_log(machine, 16);
  const auto d = compare_replay(log, replay<machine::DoubleSignals>(machine, log), 0, 0.0);
  EXPECT_LT(d.position, 0.2e-6);
}

TEST(Replay, GivesValuesBetweenTicks) {
  const auto machine = test::cross_table();
  auto log = circle_log(machine, 16);
  for (double& t : log.t) t += 20e-6;
  const auto shifted = replay<FixedSignals>(machine, log);
  EXPECT_EQ(shifted.t.size(), shifted.axes[0].x.size());
  // The log's clock and the machine's ticks begin together, wherever the log's zero is.
  EXPECT_LT(greatest(shifted.axes[0].x, log.axes[0].x), 1e-6);
  log = circle_log(machine, 16);
  Log fine;  // four samples a tick
  fine.source = "fine";
  fine.period = 62.5e-6 / 4;
  fine.axes.resize(1);
  fine.axes[0].axis = "X";
  for (int k = 0; k < 4000; ++k) {
    fine.t.push_back(k * fine.period);
    fine.axes[0].x_set.push_back(1e-3 * (1.0 - std::cos(20.0 * fine.t.back())));
    fine.axes[0].x.push_back(0.0);
  }
  const auto dense = replay<FixedSignals>(machine, fine);
  for (std::size_t k = 3000; k + 4 < 4000; k += 4)
    EXPECT_NEAR(dense.axes[0].x[k + 2], 0.5 * (dense.axes[0].x[k] + dense.axes[0].x[k + 4]), 1e-15);
}

TEST(Replay, ActsWithTheLogsExternalForce) {
  auto machine = test::cross_table();
  machine.axes.resize(1);
  Log log;
  log.source = "push";
  log.period = 1e-3;
  log.axes.resize(1);
  for (int k = 0; k < 500; ++k) {
    log.t.push_back(k * 1e-3);
    log.axes[0].x_set.push_back(0.01);
    log.axes[0].x.push_back(0.01);
    log.axes[0].external_force.push_back(k < 100 ? 0.0 : 1500.0);
  }
  const auto pushed = replay<FixedSignals>(machine, log);
  // The motor holds against the push; friction takes part with at most its Coulomb level.
  EXPECT_NEAR(pushed.axes[0].force.back(), -1500.0, 120.0);
  EXPECT_NEAR(pushed.axes[0].x.front(), 0.01, 1e-9);
}

TEST(Replay, AddsTheEncodersOtherZero) {
  auto machine = test::cross_table();
  auto log = circle_log(machine, 16);
  for (double& x : log.axes[0].x) x += 0.25;
  const auto again = replay<FixedSignals>(machine, log);
  EXPECT_LT(greatest(again.axes[0].x, log.axes[0].x), 20e-6);
  EXPECT_NEAR(encoder_offset(log.axes[0], 2e-3), 0.25, 20e-6);
  EXPECT_EQ(encoder_offset(log.axes[1], 2e-3), 0.0);
}

TEST(Replay, RefusesALogThatDoesNotFitTheMachine) {
  const auto machine = test::cross_table();
  const auto refusal = [&](const Log& log, const std::string& axis = "") -> std::string {
    try {
      replay<FixedSignals>(machine, log, {axis});
    } catch (const LogError& error) {
      return error.what();
    }
    return "";
  };
  Log log;
  log.source = "run.csv";
  log.period = 1e-3;
  log.t = {0.0, 1e-3, 2e-3};
  log.axes.resize(1);
  log.axes[0].x = {0.0, 0.0, 0.0};
  EXPECT_NE(refusal(log).find("run.csv: found channels without an axis"), std::string::npos) << refusal(log);
  EXPECT_NE(refusal(log, "Q").find("found the axis Q; expected one of mcfv5050ln: X, Y"), std::string::npos);
  EXPECT_NE(refusal(log, "X").find("found no x_set[m]"), std::string::npos) << refusal(log, "X");
  log.axes[0].x_set = {0.0, 0.01, 0.02};
  EXPECT_NE(refusal(log, "X").find("found a set velocity of 10 m/s (from x_set)"), std::string::npos)
      << refusal(log, "X");
}

}  // namespace
}  // namespace stiction::host
