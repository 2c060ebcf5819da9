// The friction model of the measured machine: its parameters come from the permitted rows alone, and what it predicts
// of the others and of the path "L" (docs/friction_model.md).
#include "host/identify/measured_machine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "host/identify/measured_machine_result.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using namespace host;

const MeasuredMachineStudy& study() {
  static const auto done = study_measured_machine(cross_table(), cross_table());
  return done;
}

// Without the predictions.
const MeasuredMachine& identified() {
  static const auto done = identify_measured_machine(cross_table());
  return done;
}

std::vector<double> numbers_of(const MeasuredMachine& m) {
  std::vector<double> numbers{m.sliding.creeping, m.sliding.rise, m.sliding.rise_velocity, m.sliding.viscous};
  for (const auto& axis : m.axes) {
    const auto& p = axis.friction;
    numbers.insert(numbers.end(),
                   {axis.force, axis.displacement, axis.error, axis.current, p.viscous, p.rise, p.rise_velocity});
    numbers.insert(numbers.end(), p.stiffness.begin(), p.stiffness.end());
    numbers.insert(numbers.end(), p.level.begin(), p.level.end());
  }
  return numbers;
}

TEST(MeasuredMachine, ParametersAreTheSameToTheBitWhateverTheOtherRowsSay) {
  auto machine = cross_table();
  std::erase_if(machine.circle_references, [](const auto& row) { return !row.measured && row.axis == "Y"; });
  double value = 1.0;
  for (auto& row : machine.circle_references) {
    if (row.measured && std::abs(row.feed - calibration_feed) < 1e-9) continue;
    row.error = value * 1e-6;
    row.current = 100.0 / value;
    value = std::fmod(value * 7.3, 31.0) + 0.1;
  }
  EXPECT_EQ(numbers_of(identify_measured_machine(machine)), numbers_of(identified()));
}

TEST(MeasuredMachine, ParametersFollowThePermittedRows) {
  auto machine = cross_table();
  for (auto& row : machine.circle_references)
    if (row.measured && row.axis == "X" && std::abs(row.feed - calibration_feed) < 1e-9) row.current = 3.8;
  EXPECT_GT(identify_measured_machine(machine).axes[0].force, 1.02 * identified().axes[0].force);
}

TEST(MeasuredMachine, MeetsTheRowsOfTheCalibration) {
  const std::vector<double> error{7.0e-6, 8.5e-6}, current{3.6, 8.3};
  for (std::size_t k = 0; k < 2; ++k) {
    // A step of the 1 um quantizer, a millisecond earlier or later, moves the peak by this much.
    EXPECT_NEAR(identified().axes[k].error, error[k], 0.05e-6);
    EXPECT_NEAR(identified().axes[k].current, current[k], 0.01);
  }
}

TEST(MeasuredMachine, PredictsTheFeedsItHasNotSeen) {
  const auto scores = held_out_scores(study().rows);
  ASSERT_EQ(scores.size(), 2u);
  ASSERT_EQ(std::count_if(study().rows.begin(), study().rows.end(), [](const auto& row) { return row.held_out; }), 8);
  const double mean = mean_of(scores);
  figure("held-out feeds of Tab 6.4, mean of the four quantities",
         fmt::format("{:.2f} % (bound 5.5 %, together with the L-shape 6.5 %; published model 9.7 %)", mean * 100));
  figure("held-out feeds: x_e, y_e",
         fmt::format("{:.1f} %, {:.1f} % (bound 7 %)", scores[0].error * 100, scores[1].error * 100));
  figure("held-out feeds: I_x, I_y",
         fmt::format("{:.1f} % (bound 4 %), {:.1f} % (bound 8 %)", scores[0].current * 100, scores[1].current * 100));
  EXPECT_LE(mean, 0.055);
  EXPECT_LE(scores[0].error, 0.07);
  EXPECT_LE(scores[1].error, 0.07);
  EXPECT_LE(scores[0].current, 0.04);
  EXPECT_LE(scores[1].current, 0.08);
}

TEST(MeasuredMachine, KeepsItsCurrentAtStandstillAndRestartsSmoothlyInTheSameDirection) {
  figure("L-shape with the same parameters: standstill current of Y",
         fmt::format("{:.2f} A, {:.0f} % of creeping friction, {:.0f} % of the published F_C = 220 N (bound 80 %)",
                     study().l_shape.kept_current(), study().kept_share() * 100,
                     study().l_shape.kept_current() * 94.0 / 220.0 * 100));
  figure("L-shape with the same parameters: restart, same direction of opposite",
         fmt::format("{:.1f} % ({:.2f} of {:.2f} um) (bound 20 %)", study().restart_share() * 100,
                     study().l_shape.same_error * 1e6, study().l_shape.opposite_error * 1e6));
  EXPECT_GE(study().kept_share(), 0.8);
  EXPECT_LE(study().restart_share(), 0.2);
}

TEST(FrictionCurves, SlidingCurveIsFoundAgain) {
  const SteadyCurve truth{70.0, 60.0, 0.02, 300.0, 0.0};
  std::vector<SteadyPoint> points;
  for (const double v : {3e-4, 2e-3, 8e-3, 0.02, 0.05, 0.1, 0.2, 0.4}) points.push_back({v, truth.at(v)});
  const auto fit = fit_steady_curve(points);
  EXPECT_NEAR(fit.creeping, 70.0, 1e-4);
  EXPECT_NEAR(fit.rise, 60.0, 1e-4);
  EXPECT_NEAR(fit.rise_velocity, 0.02, 1e-7);
  EXPECT_NEAR(fit.viscous, 300.0, 1e-3);
}

TEST(FrictionCurves, WhatTheDataDoNotDetermineIsSaid) {
  EXPECT_THROW(fit_steady_curve({{0.1, 90.0}, {0.2, 95.0}}), MissingRows);
  EXPECT_THROW(fit_steady_curve({{0.1, 90.0}, {0.2, 80.0}, {0.3, 70.0}, {0.4, 60.0}, {0.5, 50.0}}), MissingRows);
  EXPECT_THROW(presliding_curve({{true, 20.0, 1e-6}, {true, 40.0, 2e-6}, {false, 20.0, 1e-6}}), MissingRows);
  EXPECT_THROW(presliding_curve({{false, 20.0, 1e-6}, {false, 40.0, 1.5e-6}}), MissingRows) << "stiffens";
  auto machine = cross_table();
  std::erase_if(machine.circle_references, [](const auto& row) { return row.measured && row.axis == "Y"; });
  EXPECT_THROW(permitted_rows(machine), MissingRows);
}

TEST(FrictionElements, FirstLoadingIsTheMeasuredOne) {
  const auto curve = presliding_curve(permitted_rows(cross_table()).presliding);
  const auto p = friction_elements({curve.coulomb(), 0.0, 0.02, 0.0, 0.0}, curve, 1.0, 1.0);
  constexpr double nanometre = 1e-9, step = 15.625e-6;
  sim::MaxwellSlip<> contact(p, {225.0, step});
  double travelled = 0.0;
  for (const double point : {0.3e-6, 2.0e-6, 6.3e-6, 20e-6, 47e-6}) {
    double force = 0.0;
    for (; travelled < point - 0.5 * nanometre; travelled += nanometre) force = contact.move_contact(nanometre / step);
    EXPECT_NEAR(force, curve.force_at(point), 1e-6) << point;
  }
}

TEST(FrictionElements, CarryTheSlidingCurve) {
  const SteadyCurve sliding{70.0, 60.0, 0.02, 300.0, 0.0};
  const auto p = friction_elements(sliding, {{1e-6, 10e-6}, {60.0, 110.0}}, 2.0, 5.0);
  EXPECT_NEAR(std::accumulate(p.level.begin(), p.level.end(), 0.0), 140.0, 1e-9);
  EXPECT_EQ(p.rise, 120.0);
  EXPECT_EQ(p.viscous, 600.0);
  for (const double k : p.stiffness) EXPECT_GT(k, 0.0);
}

}  // namespace
}  // namespace stiction::test
