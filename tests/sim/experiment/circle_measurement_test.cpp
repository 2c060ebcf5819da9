// The circle's figures from deviations whose answer is known.
#include "sim/experiment/circle_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

namespace stiction::sim {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radius = 0.09;
constexpr int samples = 7200;

// A lap in which the carriage stands at radius + deviation(angle), plus a shift of the centre.
CircleRun lap(const std::function<double(double)>& deviation, double shift_x = 0.0, double shift_y = 0.0,
              Direction direction = Direction::counter_clockwise) {
  const CircleSettings settings{0.2, radius, direction, 2.0, 40.0};
  CircleMeasurement measurement(settings, 62.5e-6, {"x", "y"});
  const double sense = direction == Direction::counter_clockwise ? 1.0 : -1.0;
  // From before the lap to beyond it: what lies outside must not count.
  for (int i = -samples; i < 2 * samples; ++i) {
    const double turned = CirclePath::lap_begin + 2.0 * pi * (i + 0.5) / samples;
    const double angle = sense * turned;
    const bool inside = i >= 0 && i < samples;
    const double r = radius + (inside ? deviation(angle) : 1e-3);
    CirclePath::Point set{turned, {{{radius * std::cos(angle), 0.0, 0.0}, {radius * std::sin(angle), 0.0, 0.0}}}};
    measurement.add(set,
                    {{{r * std::cos(angle) + shift_x, 0.0, 0.0, 0.0}, {r * std::sin(angle) + shift_y, 0.0, 0.0, 0.0}}});
  }
  return measurement.finish();
}

TEST(CircleMeasurement, APerfectCircleHasNoErrors) {
  const auto run = lap([](double) { return 0.0; });
  EXPECT_EQ(run.angle.size(), static_cast<std::size_t>(samples));
  EXPECT_NEAR(run.errors.circular_error, 0.0, 1e-16);
  EXPECT_NEAR(run.errors.radial_error_max, 0.0, 1e-16);
  EXPECT_NEAR(run.errors.radial_error_min, 0.0, 1e-16);
}

TEST(CircleMeasurement, AShiftedCentreShowsInFAndInTheCentreButNotInG) {
  constexpr double c_x = 12e-6, c_y = -5e-6;
  const auto run = lap([](double) { return 0.0; }, c_x, c_y);
  const double shift = std::hypot(c_x, c_y);
  // The radius of a shifted circle is R + c cos(..) + c^2 sin^2(..) / 2R: c^2 / 2R = 0.94 nm remains beside the linear
  // fit, half of it as an oval.
  const double second = shift * shift / (2.0 * radius);
  EXPECT_NEAR(run.errors.centre[0], c_x, 1e-3 * second);
  EXPECT_NEAR(run.errors.centre[1], c_y, 1e-3 * second);
  EXPECT_NEAR(run.errors.circular_error, 0.0, 1.001 * second);
  EXPECT_NEAR(run.errors.radial_error_max, shift, 1e-11);  // the nearest sample is 0.25 mrad / 2 off: c * 1e-8
  EXPECT_NEAR(run.errors.radial_error_min, -shift, 1e-11);
}

TEST(CircleMeasurement, AnOvalHasTwiceItsAmplitudeAsG) {
  for (const auto direction : {Direction::counter_clockwise, Direction::clockwise}) {
    const auto run = lap([](double a) { return 4e-6 * std::cos(2.0 * a + 0.3); }, 0.0, 0.0, direction);
    EXPECT_NEAR(run.errors.circular_error, 8e-6, 1e-11);  // samples beside the peaks: 4 um * (0.87 mrad)^2 / 2
    EXPECT_NEAR(run.errors.radial_error_max, 4e-6, 1e-11);
    EXPECT_NEAR(run.errors.radial_error_min, -4e-6, 1e-11);
    EXPECT_NEAR(run.errors.centre[0], 0.0, 1e-15);
    EXPECT_NEAR(run.errors.centre[1], 0.0, 1e-15);
  }
}

TEST(CircleMeasurement, AWrongRadiusShowsInFOnly) {
  const auto run = lap([](double) { return -3e-6; });
  EXPECT_NEAR(run.errors.circular_error, 0.0, 1e-16);
  EXPECT_NEAR(run.errors.radial_error_max, -3e-6, 1e-16);
  EXPECT_NEAR(run.errors.radial_error_min, -3e-6, 1e-16);
}

TEST(CircleMeasurement, OvalShiftAndRadiusSuperpose) {
  const auto run = lap([](double a) { return -2e-6 + 4e-6 * std::cos(2.0 * a); }, 7e-6, 0.0);
  EXPECT_NEAR(run.errors.circular_error, 8e-6, 1e-9);  // second order of the shift: c^2 / 2R = 0.27 nm
  EXPECT_NEAR(run.errors.radial_error_max, 7e-6 + 4e-6 - 2e-6, 1e-9);
  EXPECT_NEAR(run.errors.centre[0], 7e-6, 1e-9);
}

TEST(CircleMeasurement, QuadrantGlitchesCountInG) {
  // Four peaks of 9 um, narrow against the turn: their mean hardly moves the fit (13.5 mrad of 2 pi * 9 um).
  const auto run = lap([](double a) {
    const double from_quadrant = std::remainder(a, 0.5 * pi);
    return std::abs(from_quadrant) < 0.01 ? 9e-6 * (1.0 - std::abs(from_quadrant) / 0.01) : 0.0;
  });
  EXPECT_NEAR(run.errors.circular_error, 9e-6, 9e-6 * 0.05);
  EXPECT_NEAR(run.errors.radial_error_max, 9e-6, 9e-6 * 0.05);
}

TEST(CircleMeasurement, BothDirectionsShareOneAnnulusAndTheirMeanRadius) {
  // Apart by 6 um in radius: each lap alone is round, together they are 6 um wide; D is the mean of both.
  const auto a = lap([](double) { return 5e-6; });
  const auto b = lap([](double) { return -1e-6; }, 0.0, 0.0, Direction::clockwise);
  const auto both = bidirectional_errors(a, b);
  EXPECT_NEAR(both.circular_error, 6e-6, 1e-15);
  EXPECT_NEAR(both.mean_radial_error, 2e-6, 1e-15);
}

TEST(CircleMeasurement, BothDirectionsAreSeenFromOneCentre) {
  // Backlash-like: the centres of the two laps differ by 8 um in x; about the one in the middle each is 4 um off.
  const auto a = lap([](double) { return 0.0; }, 4e-6, 0.0);
  const auto b = lap([](double) { return 0.0; }, -4e-6, 0.0, Direction::clockwise);
  const auto both = bidirectional_errors(a, b);
  EXPECT_NEAR(both.circular_error, 8e-6, 1e-9);  // second order: 0.09 nm
  EXPECT_NEAR(both.mean_radial_error, 0.0, 1e-9);
  const auto c = lap([](double) { return 0.0; }, 4e-6, 0.0, Direction::clockwise);
  EXPECT_NEAR(bidirectional_errors(a, c).circular_error, 0.0, 1e-9) << "a common shift is no error of the circle";
}

TEST(CircleMeasurement, PeaksAreTheLargestMagnitudesOfTheLapAlone) {
  const CircleSettings settings{0.2, radius, Direction::counter_clockwise, 2.0, 40.0};
  CircleMeasurement measurement(settings, 62.5e-6, {"x", "y"});
  const auto add = [&](double turned, double error, double held, double current) {
    measurement.add({turned, {}}, {{{radius, error, held, current}, {0.0, 0.5 * error, 0.5 * held, -2.0 * current}}});
  };
  add(CirclePath::lap_begin - 1e-9, 1.0, 1.0, 100.0);  // before the lap
  add(CirclePath::lap_begin, 1e-6, 1e-6, 1.0);
  add(CirclePath::lap_begin + 1.0, -9.4e-6, -9e-6, -3.0);
  add(CirclePath::lap_begin + 2.0, 3e-6, 3e-6, 2.0);
  add(CirclePath::lap_end, 1.0, 1.0, 100.0);  // behind it
  const auto run = measurement.finish();
  ASSERT_EQ(run.axes[0].error.size(), 3u);
  EXPECT_EQ(run.axes[0].axis, "x");
  EXPECT_EQ(run.axes[1].axis, "y");
  EXPECT_EQ(run.axes[0].peak_error, 9.4e-6);
  EXPECT_EQ(run.axes[0].peak_error_quantised, 9e-6);
  EXPECT_EQ(run.axes[0].peak_current, 3.0);
  EXPECT_EQ(run.axes[1].peak_current, 6.0);
}

TEST(CircleMeasurement, AnglesAreThoseOfTheSetPoint) {
  const auto run = lap([](double) { return 0.0; }, 0.0, 0.0, Direction::clockwise);
  // The lap begins 45 degrees beyond a quadrant; clockwise that is at -45 degrees.
  EXPECT_NEAR(run.angle.front(), -0.25 * pi, 2.0 * pi / samples);
  EXPECT_LT(run.angle[1], run.angle[0]);
}

TEST(CircleMeasurement, ALapThatWasNotReachedIsAnError) {
  const CircleMeasurement measurement({0.2, radius, Direction::counter_clockwise, 2.0, 40.0}, 62.5e-6, {"x", "y"});
  EXPECT_THROW(measurement.finish(), std::logic_error);
}

}  // namespace
}  // namespace stiction::sim
