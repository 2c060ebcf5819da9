// Methods against residual vibration on the test rig of Dostrasil 2014: the figures of an independent prototype
// (docs/residual_vibration.md), and properties that each method has by its construction.
#include "sim/cam/shaping/methods.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/shaping/band_optimal.hpp"
#include "sim/cam/shaping/input_shapers.hpp"
#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/pulses.hpp"
#include "tests/sim/cam/stand/study.hpp"
#include "tests/support/figure.hpp"

namespace stiction::sim::cam {
namespace {

constexpr double speed = 130.0 * turns_a_minute;

ShapingTask task_of_law(const std::string& law, double rise = 180.0, const LiftLimits& limits = {}) {
  return shaping_task(indexing(law, 30.0, rise), study_drive(), speed, 0.2, limits);
}

double peak_to_peak(const ShapingTask& task, const Curve& lift, double from = 0.0) {
  const Motion motion = compose(with_lift(task.motion.cam, lift));
  const auto states = transfer_response(task.drive, motion, {.master_speed = speed, .step = 0.1e-3});
  Dwell dwell = task.dwell;
  if (from > 0.0) dwell = {from, task.dwell.end() - from};
  return dwell_figures(states, motion, dwell).peak_to_peak / degree;
}

TEST(Shaping, TheTaskIsTheRiseIntoTheLongestDwell) {
  const auto task = task_of_law("parabola");
  EXPECT_NEAR(task.begin, 0.0, 1e-12);
  EXPECT_NEAR(task.end() / degree, 180.0, 1e-9);
  EXPECT_NEAR(task.stroke / degree, 30.0, 1e-9);
  EXPECT_NEAR(task.periods(), 3.34, 0.005);
  EXPECT_NEAR(task.period_length() / degree, 53.87, 0.05);
}

// As first published: a bump of one period, begun within half a period behind the rise.
TEST(Shaping, PulseInTheDwellCancelsTheVibrationBehindIt) {
  struct Row {
    const char* law;
    double start, amplitude;
  };
  for (const Row& row : {Row{"sloping_sine", 184.0, -0.131}, Row{"parabola", 185.3, -0.425}}) {
    const auto task = task_of_law(row.law);
    const double length = task.period_length();
    const auto pulse = tuned_dwell_pulse(task, length);
    ASSERT_TRUE(pulse) << row.law;
    EXPECT_NEAR(pulse->position / degree, row.start, 0.3) << row.law;
    EXPECT_NEAR(pulse->amplitude / degree, row.amplitude, 0.02 * std::fabs(row.amplitude)) << row.law;
    const auto lift = with_dwell_pulse(task, *pulse, length);
    // Once the drive has followed it, 9 ms later; before, what its own mode leaves is there too.
    const double left = peak_to_peak(task, lift, pulse->position + length + drive_lag(task));
    EXPECT_LE(left, 0.01) << row.law;
    EXPECT_LE(peak_to_peak(task, lift, pulse->position + length), 0.03) << row.law;
    test::figure(fmt::format("cam shaping: pulse of first publication, {}, behind it", row.law),
                 fmt::format("{:.4f} deg", left));
  }
}

TEST(Shaping, OptimumOfTheExtendedPulseIsThatOfThePrototype) {
  struct Row {
    const char* law;
    double length, position, amplitude;
  };
  for (const Row& row : {Row{"polynomial_3_4_5", 50, 119.7, -1.502}, Row{"polynomial_3_4_5", 35, 127.3, -1.045},
                         Row{"parabola", 50, 119.65, -1.688}, Row{"sloping_sine", 50, 119.65, -1.402},
                         Row{"polynomial_4_5_6_7", 50, 119.65, -1.269}}) {
    const auto task = task_of_law("parabola");
    const auto pulse = tuned_pulse(task, row.law, row.length * degree);
    ASSERT_TRUE(pulse) << row.law;
    EXPECT_NEAR(pulse->position / degree, row.position, 0.3) << row.law << row.length;
    EXPECT_NEAR(pulse->amplitude / degree, row.amplitude, 0.02 * std::fabs(row.amplitude)) << row.law << row.length;
    EXPECT_LE(peak_to_peak(task, with_pulse(task, *pulse, row.law, row.length * degree)), 0.04);
  }
}

TEST(Shaping, TwoPulsesCancelAnyVibrationByOneLinearEquation) {
  for (const char* law : {"parabola", "sloping_sine", "polynomial_3_4_5", "modified_sine"})
    for (const double rise : {120.0, 180.0}) {
      const auto task = task_of_law(law, rise);
      const auto made = shaped(task, *find_shaping_method("two-pulses"));
      ASSERT_TRUE(made) << law;
      // The drive's own mode is not cancelled: it has died after a tenth of a turn.
      const auto left = std::abs(residual_of(task, *find_shaping_method("two-pulses")->lift(task), task.end()));
      EXPECT_LE(left, 1e-6 * task.stroke) << law << rise;
    }
}

// What comes back is taken up at every frequency of the band; the motor rests where the rise ends.
TEST(Shaping, AWaveIsSentOffAndTakenUp) {
  const auto task = task_of_law("parabola");
  const auto made = shaped(task, *find_shaping_method("wave-based"));
  ASSERT_TRUE(made);
  EXPECT_LT(made->from_rest.worst, 0.25 * degree);
  EXPECT_NEAR(made->rise, 180.0 * degree, 1e-9);
  EXPECT_NEAR(made->motion.curve.derivative(task.end(), 0, Side::left), 30.0 * degree, 1e-9);
  EXPECT_NEAR(made->motion.curve.derivative(task.end(), 1, Side::left), 0.0, 1e-6);
  EXPECT_FALSE(shaped(task_of_law("parabola", 40.0), *find_shaping_method("wave-based"))) << "no time to come back";
}

// The table of docs/residual_vibration.md: five frequencies, and the peak acceleration over the parabola's.
TEST(Shaping, RowsOfTheTableAreThoseOfThePrototype) {
  struct Row {
    const char* method;
    double left[5];
    double acceleration;
  };
  constexpr Row rows[] = {
      {"none", {2.535, 2.766, 1.645, 0.467, 0.043}, 1.00},
      {"pulse", {2.553, 1.583, 0.033, 1.112, 1.312}, 1.99},
      {"zv", {0.739, 0.244, 0.004, 0.101, 0.250}, 1.73},
      {"mzv", {0.496, 0.259, 0.003, 0.021, 0.095}, 1.89},
      {"zvd", {0.063, 0.058, 0.003, 0.035, 0.037}, 1.87},
      {"ei", {0.034, 0.058, 0.118, 0.039, 0.021}, 1.82},
      {"polydyne", {0.448, 0.127, 0.011, 0.070, 0.119}, 1.67},
      {"inverse-dynamics", {0.097, 0.116, 0.000, 0.010, 0.051}, 1.93},
  };
  const auto task = task_of_law("parabola");
  double worst = 0.0;
  const auto compare = [&](const ShapedMotion& made, const double(&left)[5], double acceleration,
                           std::string_view name) {
    for (std::size_t k = 0; k < 5; ++k) {
      const double found = made.from_rest.figures[k].peak_to_peak / degree;
      const double allowed = std::max(0.03 * left[k], 0.003);
      EXPECT_NEAR(found, left[k], allowed) << name << " at " << made.from_rest.factors[k];
      worst = std::max(worst, std::fabs(found - left[k]) / allowed);
    }
    EXPECT_NEAR(made.acceleration_ratio, acceleration, 0.01 * acceleration + 0.005) << name;
  };
  for (const Row& row : rows) {
    const auto made = shaped(task, *find_shaping_method(row.method));
    ASSERT_TRUE(made) << row.method;
    compare(*made, row.left, row.acceleration, row.method);
  }
  constexpr double alone[5] = {1.241, 0.668, 0.086, 0.341, 0.248};
  const auto law = shaped(task_of_law("polynomial_4_5_6_7"), *find_shaping_method("none"));
  compare(*law, alone, 1.88, "4-5-6-7 alone");
  test::figure("cam shaping: nine rows at five frequencies, worst share of 3 % or 0.003 deg",
               fmt::format("{:.2f}", worst));
}

// The tenth row: ours is a different optimum than the prototype's, so its bounds are held, and simulated again.
TEST(Shaping, BandOptimalLiftHoldsOverTheBandWithLessAcceleration) {
  const auto task = task_of_law("parabola", 180.0, {.speed = 3.0, .acceleration = 7.0, .jerk = 120.0});
  const auto optimal = band_optimal_lift(task);
  ASSERT_TRUE(optimal);
  const Motion motion = compose(with_lift(task.motion.cam, optimal->lift));
  const auto figures = band_figures(task, motion, 41);
  EXPECT_LE(figures.worst / degree, 0.025);
  // Between the programme's frequencies and samples it may be a little more than its bound.
  EXPECT_LE(figures.worst, 2.0 * optimal->bound * 1.1);
  const double acceleration =
      extremes(optimal->lift, 2).magnitude() * std::numbers::pi * std::numbers::pi / task.stroke;
  EXPECT_LE(acceleration, 1.8 * 4.0);
  EXPECT_LE(extremes(optimal->lift, 3).magnitude() * std::pow(std::numbers::pi, 3) / task.stroke, 120.0 * (1.0 + 1e-6));
  test::figure("cam shaping: band-optimal lift, 20 %, peak to peak at most; acceleration of the parabola's",
               fmt::format("{:.4f} deg; {:.3f}", figures.worst / degree, acceleration / 4.0));
}

TEST(Shaping, FrontierIsThatOfThePrototype) {
  const double damping = load_mode(study_drive()).damping_ratio();
  const std::map<double, double> least{{2.0, 1.13}, {2.5, 0.18}, {3.0, 0.027}, {3.34, 0.007}};
  std::string text;
  for (const auto& [periods, wanted] : least) {
    const auto found = least_residual(periods, damping, 0.2, {});
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found * 30.0, wanted, 0.1 * wanted) << periods;
    text += fmt::format("{}{:.2g}", text.empty() ? "" : ", ", *found * 30.0);
  }
  test::figure("cam shaping: least residual at 2, 2.5, 3, 3.34 periods, 20 %", text + " deg");
  const auto shortest = shortest_rise(0.027 / 30.0, damping, 0.2, {});
  ASSERT_TRUE(shortest);
  EXPECT_NEAR(*shortest, 3.0, 0.05);
  EXPECT_FALSE(shortest_rise(0.0, damping, 0.2, {.speed = 3.0, .acceleration = 3.9, .jerk = 120.0}))
      << "no rise is possible with less acceleration than the parabola's";
}

// By their definition: at the frequency that they are made for, ZV, MZV and ZVD leave nothing of an undamped vibration,
// EI a twentieth.
TEST(Shaping, ShapersLeaveWhatTheyAreDefinedBy) {
  for (const auto& shaper : input_shapers()) {
    double cosine = 0.0, sine = 0.0, sum = 0.0;
    for (const auto& impulse : shaper.impulses(0.0)) {
      sum += impulse.share;
      cosine += impulse.share * std::cos(2.0 * std::numbers::pi * impulse.time);
      sine += impulse.share * std::sin(2.0 * std::numbers::pi * impulse.time);
    }
    EXPECT_NEAR(sum, 1.0, 1e-15) << shaper.name;
    const double left = std::hypot(cosine, sine);
    EXPECT_NEAR(left, shaper.name == "ei" ? ei_tolerance : 0.0, 1e-12) << shaper.name;
  }
}

TEST(Shaping, EveryMethodsMotionFileRisesAsTheOldOneWithoutAJumpOfTheSpeed) {
  for (const double rise : {120.0, 180.0}) {
    const auto task = task_of_law("sloping_sine", rise);
    for (const auto& method : shaping_methods()) {
      const auto made = shaped(task, method);
      // In two periods of the load the wave is not back.
      if (method.name == "wave-based" && task.periods() < 3.0) {
        EXPECT_FALSE(made);
        continue;
      }
      ASSERT_TRUE(made) << method.name << rise;
      EXPECT_EQ(problem_of(made->cam), "") << method.name;
      EXPECT_NEAR(made->cam.cycle(), 2.0 * std::numbers::pi, 1e-9);
      EXPECT_NEAR(made->motion.curve(made->motion.curve.end()), 30.0 * degree, 1e-7) << method.name;
      const auto& pieces = made->motion.curve.pieces();
      for (std::size_t k = 0; k + 1 < pieces.size(); ++k)
        ASSERT_NEAR(pieces[k].derivative(pieces[k].end, 1), pieces[k + 1].derivative(pieces[k].end, 1), 1e-6)
            << method.name << " at " << pieces[k].end / degree;
    }
  }
}

TEST(Shaping, WhatHasNoRoomIsRefused) {
  const auto task = task_of_law("sloping_sine", 35.0);
  for (const char* name : {"pulse", "two-pulses", "mzv", "zvd", "ei", "two-hump-ei"})
    EXPECT_FALSE(shaped(task, *find_shaping_method(name))) << name;
  Cam never{.name = "never"};
  never.segments = {{.length = 3.0, .stroke = 1.0, .law = "sloping_sine"},
                    {.length = 3.0, .stroke = -1.0, .law = "sloping_sine"}};
  EXPECT_THROW(shaping_task(compose(never), study_drive(), speed, 0.2, {}), CamError);
}

}  // namespace
}  // namespace stiction::sim::cam
