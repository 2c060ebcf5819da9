// The cycle of a slave's set-points, from closed forms.
#include "host/log/repeating_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace stiction::host {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

// `seconds` at 1 kHz behind a master whose angle is `master`(t), of cycles of `cycle` rad; each set position is
// `motion`(whole and part of a cycle).
Log slave_log(double seconds, double cycle, const std::function<double(double)>& master,
              const std::function<double(double)>& motion) {
  Log log;
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  for (double t = 0.0; t < seconds; t += log.period) {
    const double cycles = master(t) / cycle;
    log.t.push_back(t);
    axis.master.push_back(cycle * (cycles - std::floor(cycles)));
    axis.x_set.push_back(motion(cycles));
  }
  axis.x = axis.x_set;
  return log;
}

std::optional<RepeatingMotion> found_in(const Log& log) {
  return repeating_motion(log, log.axes.front(), SetPoints(log, log.axes.front()));
}

// Twice a wave in a cycle, and 30 mm on in each.
double indexing(double cycles) { return 0.03 * cycles + 0.01 * std::sin(2.0 * turn * cycles); }

TEST(RepeatingMotion, HasPeriodAndRiseOfTheCycle) {
  for (const double cycle : {turn, 0.25 * turn})
    for (const double speed : {3.1, -2.3}) {
      const auto found = found_in(slave_log(
          12.0, cycle, [&](double t) { return 0.4 + speed * t; }, indexing));
      ASSERT_TRUE(found) << cycle << " " << speed;
      EXPECT_NEAR(found->period, cycle / std::abs(speed), 1e-5 * found->period);
      EXPECT_NEAR(found->rise, speed > 0.0 ? 0.03 : -0.03, 1e-6);
    }
}

TEST(RepeatingMotion, IsNoneWhereTheMasterDoesNotTurnSteadily) {
  EXPECT_FALSE(found_in(slave_log(
      12.0, turn, [](double t) { return 0.1 * t * t; }, indexing)));
  EXPECT_FALSE(found_in(slave_log(
      12.0, turn, [](double t) { return 3.0 * t + 0.2 * std::sin(t); }, indexing)));
}

TEST(RepeatingMotion, IsNoneWithoutAWholeCycle) {
  EXPECT_FALSE(found_in(slave_log(
      1.9, turn, [](double t) { return 0.4 + 3.1 * t; }, indexing)));
  auto log = slave_log(
      12.0, turn, [](double t) { return 3.1 * t; }, indexing);
  log.axes.front().master.clear();
  EXPECT_FALSE(found_in(log));
}

TEST(RepeatingMotion, IsNoneWhereOneCycleDiffersFromTheNext) {
  const auto growing = [](double cycles) { return 0.01 * (1.0 + 0.1 * cycles) * std::sin(turn * cycles); };
  EXPECT_FALSE(found_in(slave_log(
      12.0, turn, [](double t) { return 3.1 * t; }, growing)));
}

}  // namespace
}  // namespace stiction::host
