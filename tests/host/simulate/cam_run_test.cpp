// A cam through the simulated axis: what it follows, what it takes, and what the log has.
#include "host/simulate/cam_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double pi = std::numbers::pi;

machine::Machine joint() { return sim::read_machine(machine::find_machine("servo-joint")); }

sim::cam::Motion there_and_back() {
  sim::cam::Cam cam{.name = "a"};
  cam.segments = {{.length = 2.5, .stroke = 0.8, .law = "modified_sine"},
                  {.length = 0.6},
                  {.length = 2.5, .stroke = -0.8, .law = "modified_sine"},
                  {.length = 2 * pi - 5.6}};
  return sim::cam::compose(cam);
}

CamRunSettings at(double speed) {
  CamRunSettings settings;
  settings.master_speed = speed;
  settings.cycles = 1;
  return settings;
}

TEST(CamRun, FollowsMoreCloselyWithFeedforward) {
  const auto motion = there_and_back();
  auto settings = at(2.0);
  const auto with = run_cam<FixedSignals>(joint(), motion, settings);
  settings.feedforward = false;
  const auto without = run_cam<FixedSignals>(joint(), motion, settings);
  EXPECT_LT(with.error.peak, 0.1 * without.error.peak);
  // Without feedforward a position controller is late by speed over gain.
  const double speed = 0.8 * 1.7596 / 2.5 * 2.0;
  EXPECT_NEAR(without.error.peak, speed / 41.6667, 0.15 * speed / 41.6667);
  ASSERT_EQ(with.segments.size(), 4u);
  EXPECT_GT(without.segments[0].mean, without.segments[1].mean);
}

TEST(CamRun, TheMotorGivesWhatLoadRotorFrictionAndWeightTake) {
  const auto motion = there_and_back();
  const auto run = run_cam<FixedSignals>(joint(), motion, at(2.0));
  // Weight 11.77 N m sin(0.8) at the top, friction 2.2 N m, 1.9 N m for 0.6533 kg m^2, and the loops at the reversal.
  const double weight = 11.77 * std::sin(0.8), least = weight - 2.2 - 1.0, most = weight + 2.2 + 5.0;
  EXPECT_GT(run.peak_effort, least);
  EXPECT_LT(run.peak_effort, most);
  // The weight gives back what it takes; friction does not.
  EXPECT_NEAR(run.energy, 2.2 * 1.6 + 0.6 * 2.0 * 2 * 0.64 / 2.5 * 1.26, 1.0);
}

TEST(CamRun, TheLogHasMasterAndTable) {
  auto settings = at(2.0);
  settings.table = 7.0;
  const auto run = run_cam<FixedSignals>(joint(), there_and_back(), settings);
  const auto& axis = run.log.axes.front();
  ASSERT_EQ(axis.master.size(), run.log.t.size());
  EXPECT_NEAR(axis.master.front(), 0.0, 1e-3);
  EXPECT_NEAR(axis.master.back(), 2 * pi, 1e-3);
  EXPECT_EQ(axis.table.front(), 7.0);
  // The set-points are the motion at the master.
  const auto motion = there_and_back();
  for (std::size_t k = 0; k < axis.x_set.size(); k += 997)
    EXPECT_NEAR(axis.x_set[k], motion.curve(axis.master[k]), 1e-6);
}

// The estimator lags by nothing at constant speed, and what it leaves of noise and steps is far below the following
// error.
TEST(CamRun, AMasterOfNoiseOrStepsIsSeenThroughTheEstimator) {
  auto settings = at(2.0);
  const auto ideal = run_cam<FixedSignals>(joint(), there_and_back(), settings);
  for (const auto signal : {MasterSignal::steps, MasterSignal::noisy}) {
    settings.master = signal;
    const auto run = run_cam<FixedSignals>(joint(), there_and_back(), settings);
    EXPECT_NEAR(run.error.mean, ideal.error.mean, 0.2 * ideal.error.mean);
    EXPECT_NE(run.error.mean, ideal.error.mean);
  }
}

TEST(CamRun, TheMasterIsAtSpeedBeforeItsFirstCycleEnds) {
  const auto run = run_cam<FixedSignals>(joint(), there_and_back(), at(2.0));
  const auto& log = run.log;
  // From rest to 2 rad/s over a turn, at half of that speed, then a turn.
  EXPECT_NEAR(log.t.front(), 2 * pi, 0.1);
  EXPECT_NEAR(log.t.back() - log.t.front(), pi, 1e-3);
  for (const double speed : log.axes.front().master_speed) EXPECT_NEAR(speed, 2.0, 1e-9);
}

TEST(CamRun, ACurveBeyondTheLimitsIsRefusedWithFigures) {
  try {
    run_cam<FixedSignals>(joint(), there_and_back(), at(9.0));
    FAIL();
  } catch (const machine::ConfigurationError& error) {
    EXPECT_NE(std::string(error.what()).find("expected at most 3.5 rad/s, 20 rad/s^2"), std::string::npos)
        << error.what();
  }
}

// Sixteen ticks of 62.5 us: the position controller's ticks stay where they were.
TEST(CamRun, OfASlaveBehindItsMasterIsTheSameSoMuchLater) {
  constexpr std::size_t ticks = 16;
  auto late = joint();
  late.axes.front().effects = {{"master_delay", {{"delay", {ticks * late.timing.fast_period}}}}};
  const auto in_time = run_cam<FixedSignals>(joint(), there_and_back(), at(2.0)).log.axes.front();
  const auto behind = run_cam<FixedSignals>(late, there_and_back(), at(2.0)).log.axes.front();
  EXPECT_EQ(behind.x_set, in_time.x_set);  // those of the master's time
  ASSERT_EQ(behind.x.size(), in_time.x.size());
  double most = 0.0;
  for (std::size_t k = ticks; k < behind.x.size(); ++k)
    most = std::max(most, std::abs(behind.x[k] - in_time.x[k - ticks]));
  // Within some increments of the encoder of 15.3 urad, in which the axis hunts.
  EXPECT_LT(most, 5 * 15.4e-6);
  double apart = 0.0;
  for (std::size_t k = 0; k < behind.x.size(); ++k) apart = std::max(apart, std::abs(behind.x[k] - in_time.x[k]));
  EXPECT_GT(apart, 0.5 * 2.0 * 0.8 * 1.7596 / 2.5 * 1e-3);  // delay times speed, about
}

}  // namespace
}  // namespace stiction::host
