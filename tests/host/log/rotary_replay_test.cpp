// A rotary axis in the closed loop against the same axis written as a linear one.
#include <gtest/gtest.h>

#include <cmath>

#include "host/simulate/replay.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::host {
namespace {

// A sine of 0.5 rad at 1 Hz, in units of `per_radian`.
Log sine(double per_radian, bool rotary) {
  Log log;
  log.source = "sine";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  axis.axis = "J";
  axis.rotary = rotary;
  const double w = 6.0;
  for (int k = 0; k < 2000; ++k) {
    const double t = k * 1e-3;
    log.t.push_back(t);
    axis.x_set.push_back(per_radian * 0.5 * (1.0 - std::cos(w * t)));
    axis.v_set.push_back(per_radian * 0.5 * w * std::sin(w * t));
    axis.a_set.push_back(per_radian * 0.5 * w * w * std::cos(w * t));
    axis.x.push_back(axis.x_set.back());
  }
  return log;
}

TEST(RotaryReplay, HasTheBitsOfTheLinearAxisOnItsCircle) {
  constexpr int counts = 1 << 22;
  const auto joint = sim::parse_machine("joint.toml", test::rotary_joint_of(counts));
  const double radius = joint.axes[0].coordinate.radius;
  const auto circle = sim::parse_machine("joint.toml", test::joint_on_circle(radius, counts));
  const auto turned = replay<FixedSignals>(joint, sine(1.0, true));
  const auto moved = replay<FixedSignals>(circle, sine(radius, false));
  ASSERT_EQ(turned.axes[0].x.size(), moved.axes[0].x.size());
  EXPECT_TRUE(turned.axes[0].rotary);
  for (std::size_t k = 0; k < turned.t.size(); ++k) {
    ASSERT_EQ(turned.axes[0].x[k] * radius, moved.axes[0].x[k]) << k;
    ASSERT_EQ(turned.axes[0].v[k] * radius, moved.axes[0].v[k]) << k;
    ASSERT_EQ(turned.axes[0].u[k], moved.axes[0].u[k]) << k;
    ASSERT_EQ(turned.axes[0].force[k] / radius, moved.axes[0].force[k]) << k;
  }
  double most = 0.0;
  for (const double x : turned.axes[0].x) most = std::max(most, x);
  EXPECT_NEAR(most, 1.0, 0.05);
}

TEST(RotaryReplay, RefusesALogOfTheOtherKind) {
  const auto joint = sim::parse_machine("joint.toml", test::rotary_joint);
  try {
    replay<FixedSignals>(joint, sine(1.0, false));
    FAIL();
  } catch (const LogError& error) {
    EXPECT_NE(std::string(error.what()).find("found columns of a linear axis; expected those of a rotary one"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace stiction::host
