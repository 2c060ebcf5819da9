#include "host/log/set_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace stiction::host {
namespace {

constexpr double omega = 3.0, radius = 0.09;  // rad/s, m: the circle at 16 m/min

// Samples of x(t) at 1 kHz from `begin` on.
Log sampled(int samples, const std::function<double(double)>& x, double begin = 0.0) {
  Log log;
  log.source = "made up";
  log.period = 1e-3;
  log.axes.resize(1);
  for (int k = 0; k < samples; ++k) {
    log.t.push_back(begin + k * 1e-3);
    log.axes[0].x_set.push_back(x(log.t.back()));
  }
  return log;
}

double circle(double t) { return radius * std::sin(omega * t); }

struct Off {
  double x = 0.0, v = 0.0, a = 0.0;  // greatest
};
// Against the circle between samples, `margin` seconds from both ends.
Off off_the_circle(const Log& log, double margin) {
  const SetPoints set(log, log.axes[0]);
  Off off;
  for (double t = log.t.front() + margin; t < log.t.back() - margin; t += 62.5e-6) {
    const auto point = set.at(t);
    off.x = std::max(off.x, std::abs(point.position - circle(t)));
    off.v = std::max(off.v, std::abs(point.velocity - omega * radius * std::cos(omega * t)));
    off.a = std::max(off.a, std::abs(point.acceleration + omega * omega * circle(t)));
  }
  return off;
}

// The error of a cubic spline: 5/384 h^4 w^4 r in position; h^2/12 w^4 r in acceleration.
TEST(SetPoints, DeriveVelocityAndAccelerationOfASmoothMotion) {
  const auto off = off_the_circle(sampled(2000, circle), 0.01);
  EXPECT_LT(off.x, 1e-12);  // a time within a millionth of a step counts as the sample's own
  EXPECT_LT(off.v, 1e-9);
  EXPECT_LT(off.a, 2e-6);
}

TEST(SetPoints, AreExactForConstantAcceleration) {
  const auto log = sampled(
      50, [](double t) { return 2.0 + 0.3 * t - 5.0 * t * t; }, 7.0);
  const SetPoints set(log, log.axes[0]);
  for (double t = log.t.front(); t <= log.t.back(); t += 62.5e-6) {
    const auto point = set.at(t);
    EXPECT_NEAR(point.position, 2.0 + 0.3 * t - 5.0 * t * t, 1e-9);  // spline of values of 250 m: digits lost
    EXPECT_NEAR(point.velocity, 0.3 - 10.0 * t, 1e-6);
    EXPECT_NEAR(point.acceleration, -10.0, 1e-4);
  }
}

TEST(SetPoints, OvershootAnAccelerationStepByLittle) {
  const auto log = sampled(100, [](double t) { return t < 0.05 ? 0.0 : 0.5 * (t - 0.05) * (t - 0.05); });
  const SetPoints set(log, log.axes[0]);
  for (double t = 0.0; t < 0.095; t += 62.5e-6) {
    EXPECT_GT(set.at(t).acceleration, -0.135);
    EXPECT_LT(set.at(t).acceleration, 1.135);
  }
  EXPECT_NEAR(set.at(0.06).acceleration, 1.0, 1e-4);
}

TEST(SetPoints, TakeTheLogsOwnVelocityAndAcceleration) {
  auto log = sampled(1000, circle);
  for (const double t : log.t) {
    log.axes[0].v_set.push_back(omega * radius * std::cos(omega * t) * 1.001);
    log.axes[0].a_set.push_back(-omega * omega * circle(t) * 1.01);
  }
  const SetPoints set(log, log.axes[0]);
  EXPECT_TRUE(set.velocity_is_logged());
  EXPECT_TRUE(set.acceleration_is_logged());
  EXPECT_EQ(set.velocity(), log.axes[0].v_set);
  EXPECT_EQ(set.at(log.t[300]).acceleration, log.axes[0].a_set[300]);
}

// A log of 4 ms with all three channels. A straight line between two accelerations would be (w h)^2 / 8 off, 0.32 %.
TEST(SetPoints, BowTheAccelerationOfASmoothMotionBetweenSlowSamples) {
  constexpr double rate = 40.0;  // rad/s
  auto log = sampled(0, circle);
  log.period = 4e-3;
  for (int k = 0; k < 500; ++k) {
    const double t = k * log.period;
    log.t.push_back(t);
    log.axes[0].x_set.push_back(1e-3 * std::sin(rate * t));
    log.axes[0].v_set.push_back(1e-3 * rate * std::cos(rate * t));
    log.axes[0].a_set.push_back(-1e-3 * rate * rate * std::sin(rate * t));
  }
  const SetPoints set(log, log.axes[0]);
  ASSERT_TRUE(set.acceleration_is_logged());
  for (double t = 0.01; t < 1.98; t += 62.5e-6)
    EXPECT_NEAR(set.at(t).acceleration, -1e-3 * rate * rate * std::sin(rate * t), 2e-4 * 1e-3 * rate * rate) << t;
}

// A step of 1 m/s^2 at 0.0509 s, between two samples: what a machine of 1 kg makes of it by the rules of Newton, in
// small steps of time, is the record's speed and place at the samples behind it.
TEST(SetPoints, KeepMomentumAndPlaceAcrossAStepOfTheAcceleration) {
  const double step = 0.0509;
  auto log = sampled(100, [&](double t) { return t < step ? 0.0 : 0.5 * (t - step) * (t - step); });
  for (const double t : log.t) {
    log.axes[0].v_set.push_back(std::max(t - step, 0.0));
    log.axes[0].a_set.push_back(t < step ? 0.0 : 1.0);
  }
  const SetPoints set(log, log.axes[0]);
  ASSERT_TRUE(set.velocity_is_logged());
  ASSERT_TRUE(set.acceleration_is_logged());
  constexpr double h = 1e-7;  // s
  double x = 0.0, v = 0.0;
  for (double t = 0.045; t < 0.055; t += h) {
    const double a = set.at(t + 0.5 * h).acceleration;
    x += h * (v + 0.5 * h * a);
    v += h * a;
    EXPECT_GT(a, -1.0);
    EXPECT_LT(a, 2.0);
  }
  EXPECT_NEAR(v, 0.055 - step, 1e-6);
  EXPECT_NEAR(x, 0.5 * (0.055 - step) * (0.055 - step), 1e-9);
}

// A set velocity that is half a sample late: the way between two samples contradicts it, and added to the acceleration
// it would swing by six times as much.
TEST(SetPoints, LeaveAWayAloneThatContradictsTheVelocity) {
  auto log = sampled(500, circle);
  for (const double t : log.t) {
    log.axes[0].v_set.push_back(omega * radius * std::cos(omega * (t - 0.5e-3)));
    log.axes[0].a_set.push_back(-omega * omega * circle(t));
  }
  const SetPoints set(log, log.axes[0]);
  ASSERT_TRUE(set.velocity_is_logged());
  for (double t = 0.01; t < 0.48; t += 62.5e-6)
    EXPECT_NEAR(set.at(t).acceleration, -omega * omega * circle(t), 0.01 * omega * omega * radius) << t;
}

// Positions rounded to 1 um at 1 kHz: their second difference alone would be 0.7 m/s^2 of noise.
TEST(SetPoints, SmoothAPositionWrittenInCoarseSteps) {
  const auto log = sampled(2000, [](double t) { return std::round(circle(t) * 1e6) * 1e-6; });
  const SetPoints set(log, log.axes[0]);
  EXPECT_NEAR(set.increment(), 1e-6, 1e-12);
  EXPECT_GT(set.smoothing(), 0.0);
  EXPECT_LT(set.smoothing(), 0.03);
  const auto off = off_the_circle(log, 0.0);
  EXPECT_LT(off.x, 1.5e-6);  // the rounding and what the ends' windows make of it
  const auto inside = off_the_circle(log, 0.02);
  EXPECT_LT(inside.x, 0.5e-6);
  EXPECT_LT(inside.a, 5.0 * acceleration_noise);  // the greatest of 2000 values of that rms
}

TEST(SetPoints, LeaveFinePositionsAlone) {
  const auto log = sampled(2000, [](double t) { return std::round(circle(t) * 1e12) * 1e-12; });
  const SetPoints set(log, log.axes[0]);
  EXPECT_EQ(set.smoothing(), 0.0);
  EXPECT_EQ(set.position(), log.axes[0].x_set);
}

TEST(SetPoints, TakeConstantSpeedAndAccelerationForNoGrid) {
  const auto speed = sampled(1000, [](double t) { return 0.1 * t; });
  EXPECT_EQ(SetPoints(speed, speed.axes[0]).increment(), 0.0);
  const auto bang = sampled(1000, [](double t) { return t < 0.5 ? t * t : 0.25 + (t - 0.5) - (t - 0.5) * (t - 0.5); });
  EXPECT_EQ(SetPoints(bang, bang.axes[0]).increment(), 0.0);
}

TEST(SetPoints, RestOutsideTheLog) {
  const auto log = sampled(100, circle, 1.0);
  const SetPoints set(log, log.axes[0]);
  EXPECT_EQ(set.at(0.0).position, log.axes[0].x_set.front());
  EXPECT_EQ(set.at(0.0).velocity, 0.0);
  EXPECT_EQ(set.at(9.0).position, log.axes[0].x_set.back());
  EXPECT_EQ(set.at(9.0).velocity, 0.0);
  EXPECT_EQ(set.at(1.0).velocity, set.velocity().front());
}

TEST(SetPoints, AreGivenForTwoSamples) {
  const auto log = sampled(2, [](double t) { return t; });
  EXPECT_DOUBLE_EQ(SetPoints(log, log.axes[0]).at(0.5e-3).velocity, 1.0);
}

TEST(SetPoints, RefuseALogWithoutThem) {
  auto log = sampled(10, circle);
  log.axes[0].x = std::exchange(log.axes[0].x_set, {});
  log.axes[0].axis = "Y";
  try {
    const SetPoints set(log, log.axes[0]);
    FAIL();
  } catch (const LogError& error) {
    EXPECT_STREQ(error.what(),
                 "made up: found no Y.x_set[m]; expected the set position: record it with the measured one");
  }
}

}  // namespace
}  // namespace stiction::host
