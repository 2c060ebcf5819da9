#include "host/log/inspection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace stiction::host {
namespace {

constexpr double mass = 225.0, coulomb = 90.0, viscous = 500.0, constant = 94.0;  // kg, N, N s/m, N/A

// A log of `seconds` at 1 kHz of the motion x(t) with its v and a, and the current of a rigid axis plus 1 % of noise.
struct Point {
  double x, v, a;
};
Log rigid_log(double seconds, const std::function<Point(double)>& motion, double sign = 1.0) {
  Log log;
  log.source = "made up";
  log.period = 1e-3;
  log.axes.resize(1);
  auto& axis = log.axes[0];
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (int k = 0; k < static_cast<int>(seconds * 1e3); ++k) {
    const double t = k * 1e-3;
    const auto p = motion(t);
    log.t.push_back(t);
    axis.x_set.push_back(p.x + 1e-3 * p.v);
    axis.x.push_back(p.x);
    const double direction = p.v > 0.0 ? 1.0 : p.v < 0.0 ? -1.0 : 0.0;
    axis.i.push_back(sign * (mass * p.a + viscous * p.v + coulomb * direction) / constant + noise(random));
  }
  return log;
}

Point sine(double t) {
  const double w = 5.0, r = 0.05;
  return {r * std::sin(w * t), r * w * std::cos(w * t), -r * w * w * std::sin(w * t)};
}
Point steady(double t) { return {0.1 * t, 0.1, 0.0}; }
// Triangles of constant speed, both directions, no samples at the turns that would show an acceleration.
Point triangle(double t) {
  const double phase = t - std::floor(t);
  return phase < 0.5 ? Point{0.1 * phase, 0.1, 0.0} : Point{0.1 * (1.0 - phase), -0.1, 0.0};
}

const Determinable& judgement(const AxisInspection& axis, const std::string& what) {
  const auto found = std::ranges::find_if(axis.determinable, [&](const auto& d) { return d.what == what; });
  if (found == axis.determinable.end()) throw std::out_of_range(what);
  return *found;
}

bool suspects(const AxisInspection& axis, const std::string& part) {
  return std::ranges::any_of(axis.suspicions, [&](const auto& s) { return s.find(part) != std::string::npos; });
}

TEST(Inspection, MeasuresStrokeSpeedAccelerationAndReversals) {
  const auto axis = inspect(rigid_log(6.0, sine)).axes[0];
  EXPECT_NEAR(axis.stroke, 0.1, 1e-5);
  EXPECT_NEAR(axis.max_speed, 0.25, 1e-3);
  EXPECT_NEAR(axis.max_acceleration, 1.25, 0.01);
  EXPECT_EQ(axis.reversals, 10);  // one every pi / 5 s, the first at pi / 10
  EXPECT_NEAR(axis.forward, 0.5, 0.05);
  EXPECT_NEAR(axis.delay.value(), 1e-3, 1e-5);
}

TEST(Inspection, FindsConstantSpeeds) {
  const auto axis = inspect(rigid_log(4.0, triangle)).axes[0];
  ASSERT_EQ(axis.plateaus.size(), 2u);
  EXPECT_NEAR(axis.plateaus[0].speed, -0.1, 1e-4);
  EXPECT_NEAR(axis.plateaus[1].speed, 0.1, 1e-4);
  EXPECT_GT(axis.plateaus[1].duration, 1.8);
  EXPECT_TRUE(inspect(rigid_log(6.0, sine)).axes[0].plateaus.empty());
}

// A motion with everything in it: the rigid parameters are all there, within the noise.
TEST(Inspection, FindsTheRigidParametersOfASine) {
  const auto axis = inspect(rigid_log(20.0, sine), {{mass, constant, 70.0, 0.072, {}}}).axes[0];
  for (const auto* what : {"Level of Coulomb friction", "Slope of viscous friction", "Moving mass", "Constant force"})
    EXPECT_TRUE(judgement(axis, what).possible) << what << ": " << judgement(axis, what).reason;
  EXPECT_NEAR(axis.force_constant.value(), constant, 0.01 * constant);
  EXPECT_TRUE(axis.suspicions.empty()) << axis.suspicions.front();
}

TEST(Inspection, SaysWhatOneSpeedInOneDirectionCannotTell) {
  const auto axis = inspect(rigid_log(2.0, steady)).axes[0];
  for (const auto& d : axis.determinable) {
    if (d.what == "Force ripple (cogging)") continue;
    EXPECT_FALSE(d.possible) << d.what;
    EXPECT_FALSE(d.reason.empty()) << d.what;
    EXPECT_FALSE(d.remedy.empty()) << d.what;
  }
}

TEST(Inspection, CannotTellViscousFromCoulombAtOneSpeed) {
  const auto axis = inspect(rigid_log(10.0, triangle)).axes[0];
  EXPECT_FALSE(judgement(axis, "Slope of viscous friction").possible);
  EXPECT_NE(judgement(axis, "Slope of viscous friction").reason.find("does not separate it from Coulomb"),
            std::string::npos);
  EXPECT_TRUE(judgement(axis, "Friction differs between directions").possible);
}

bool asks(const AxisInspection& axis, Question::About about) {
  return std::ranges::any_of(axis.questions, [&](const auto& q) { return q.about == about; });
}

TEST(Inspection, AsksAboutASwappedSign) {
  EXPECT_TRUE(asks(inspect(rigid_log(10.0, sine, -1.0)).axes[0], Question::About::sign));
  EXPECT_FALSE(asks(inspect(rigid_log(10.0, sine)).axes[0], Question::About::sign));
}

TEST(Inspection, AsksAboutRmsAmperesWhereTheMachineIsKnown) {
  const auto log = rigid_log(10.0, sine, 1.0 / std::numbers::sqrt2);
  EXPECT_TRUE(asks(inspect(log, {{mass, constant, {}, {}, {}}}).axes[0], Question::About::amperes));
  const auto alone = inspect(log).axes[0];
  EXPECT_TRUE(alone.questions.empty());
  // 225 kg over 94 N/A, and the root of two.
  EXPECT_NE(alone.only_a_ratio.find("ratio of mass and force constant"), std::string::npos) << alone.only_a_ratio;
}

TEST(Inspection, SaysTheResolutionOfEachChannel) {
  auto log = rigid_log(10.0, sine);
  for (double& x : log.axes[0].x) x = 1e-6 * std::round(x / 1e-6);
  const auto axis = inspect(log).axes[0];
  ASSERT_EQ(axis.resolution.size(), 3u);
  EXPECT_STREQ(axis.resolution[1].channel->name, "x");
  EXPECT_NEAR(axis.resolution[1].increment, 1e-6, 1e-10);
  EXPECT_EQ(axis.resolution[2].increment, 0.0);
  EXPECT_NEAR(axis.resolution[2].noise, 0.01, 1e-3);  // A, as rigid_log() adds
}

TEST(Inspection, SuspectsACurrentThatStandsAtItsEnd) {
  auto log = rigid_log(10.0, sine);
  for (double& i : log.axes[0].i) i = std::clamp(i, -2.5, 2.5);
  const auto axis = inspect(log, {{mass, constant, 2.5, {}, {}}}).axes[0];
  ASSERT_EQ(axis.saturation.size(), 1u);
  EXPECT_EQ(axis.saturation[0].channel, "i");
  EXPECT_DOUBLE_EQ(axis.saturation[0].level, 2.5);
  EXPECT_TRUE(suspects(axis, "saturated"));
  EXPECT_TRUE(suspects(axis, "in the machine file, which distorts the motion"));
  EXPECT_TRUE(inspect(rigid_log(10.0, sine)).axes[0].saturation.empty());
}

TEST(Inspection, SuspectsALogWithoutSetPoints) {
  auto log = rigid_log(2.0, sine);
  log.axes[0].x_set.clear();
  EXPECT_TRUE(suspects(inspect(log).axes[0], "no x_set"));
}

TEST(Inspection, SeesSlowReversalsAsPresliding) {
  const auto slow = [](double t) {
    return Point{40e-6 * std::sin(2.0 * t), 80e-6 * std::cos(2.0 * t), -160e-6 * std::sin(2.0 * t)};
  };
  const auto axis = inspect(rigid_log(10.0, slow)).axes[0];
  EXPECT_TRUE(judgement(axis, "Presliding displacement").possible);
  EXPECT_FALSE(judgement(axis, "Stribeck effect").possible);  // creep under a spring is no speed of sliding
  EXPECT_FALSE(judgement(axis, "Level of Coulomb friction").possible);
}

TEST(Inspection, StandsALogOfTwoSamplesAndOneAtRest) {
  auto log = rigid_log(0.002, sine);
  EXPECT_FALSE(judgement(inspect(log).axes[0], "Level of Coulomb friction").possible);
  const auto rest = inspect(rigid_log(1.0, [](double) { return Point{0.3, 0.0, 0.0}; })).axes[0];
  EXPECT_EQ(rest.reversals, 0);
  EXPECT_EQ(judgement(rest, "Level of Coulomb friction").reason, "the axis hardly moves");
}

TEST(Inspection, FitsTheMotionOfAParabolaExactly) {
  std::vector<double> x;
  for (int k = 0; k < 100; ++k) x.push_back(1.0 + 0.5 * k * 1e-3 + k * k * 1e-6);
  const auto motion = fitted_motion(x, 1e-3);
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_NEAR(motion.v[k], 0.5 + 2e-3 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(motion.a[k], 2.0, 1e-7);
  }
}

}  // namespace
}  // namespace stiction::host
