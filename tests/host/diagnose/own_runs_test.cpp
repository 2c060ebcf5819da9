// What a record is held against: runs of its machine, and what of a search's terms such runs bear out.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/judge/closed_loop_description.hpp"
#include "host/diagnose/judge/closed_loop_refinement.hpp"
#include "host/diagnose/record/effect_response.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "sim/effects/effect_values.hpp"
#include "sim/effects/mass_mismatch/mass_mismatch.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::host {
namespace {

constexpr double coarse_increment = 5e-6;  // m, of the encoder

// X of the cross table with friction that follows the speed alone.
machine::Machine coarse_axis() {
  auto machine = test::cross_table();
  machine.axes.resize(1);
  auto& axis = machine.axes.front();
  axis.friction.use = "coulomb_viscous";
  axis.effects.clear();
  axis.encoder.noise = axis.position_controller.increment = 0.0;
  axis.encoder.increment = coarse_increment;
  return machine;
}

// Set-points to and fro over some 30 mm.
Log there_and_back() {
  Log log;
  log.source = "moves";
  log.period = 1e-3;
  log.axes.resize(1);
  auto& axis = log.axes.front();
  for (int k = 0; k < 6000; ++k) {
    const double t = k * log.period;
    log.t.push_back(t);
    axis.x_set.push_back(0.013 * std::min(1.0, t) * (std::sin(4.1 * t) + 0.3 * std::sin(11.0 * t)));
    axis.x.push_back(axis.x_set.back());
    axis.i.push_back(0.0);
  }
  return log;
}

// The record of such an axis whose encoder was switched on elsewhere within an increment.
Log recorded_elsewhere(const machine::Machine& machine) {
  const auto log = there_and_back();
  auto moved = log;
  for (double& x : moved.axes.front().x_set) x += 0.29 * coarse_increment;
  auto record = without_noise(machine, 0, {moved}).replayed.front();
  record.source = log.source;
  record.axes.front().x_set = log.axes.front().x_set;
  return record;
}

}  // namespace

// Of two runs with independent increments the difference has twice the square of one; of one and the mean of three 4/3.
TEST(OwnRuns, LeaveFewerIncrementsOnAverage) {
  const auto machine = coarse_axis();
  const auto& axis = machine.axes.front();
  Record record;
  record.logs = {recorded_elsewhere(machine)};
  const auto settings = signals_in(host::RowBand::usual, record.logs);
  measure(record, axis, settings);
  const Eigen::VectorXd raw = record.target;
  const auto motion = drive(record, machine, 0);
  ASSERT_FALSE(motion.empty());
  regress_on(record, motion, axis, settings);
  const Eigen::VectorXd of_one =
      (raw - own_residual(record.simulated, record.logs, axis, settings)).cwiseProduct(record.regressors.counts());
  EXPECT_LT(record.target.squaredNorm(), 0.8 * of_one.squaredNorm());
}

// What a run on the record's own increments adds to the motion of an axis with an ideal encoder is not in the columns.
TEST(OwnRuns, MoveOnOtherIncrementsThanTheRecord) {
  const auto machine = coarse_axis();
  auto ideal = machine;
  ideal.axes.front().encoder.increment = 0.0;
  const auto& axis = machine.axes.front();
  Record record;
  record.logs = {recorded_elsewhere(machine)};
  const auto settings = signals_in(host::RowBand::usual, record.logs);
  measure(record, axis, settings);
  const auto motion = drive(record, machine, 0);
  ASSERT_FALSE(motion.empty());
  regress_on(record, motion, axis, settings);
  const auto acceleration = [](const LogRows& rows) { return rows.stacked([](const Motion& one) { return one.a; }); };
  const Eigen::VectorXd smooth = acceleration(rows_of(without_noise(ideal, 0, record.driven).motion, axis, settings));
  const Eigen::VectorXd own = acceleration(rows_of(motion, axis, settings)) - smooth;
  const Eigen::VectorXd of_columns = acceleration(LogRows(record.regressors.motions(), settings)) - smooth;
  EXPECT_LT(std::abs(own.dot(of_columns)), 0.5 * own.norm() * of_columns.norm());
}

// A law without a contact seen from a run whose presliding is of nanometres: what its column explains, no run shows.
TEST(OwnRuns, BearOutNoTermThatTheyDoNotShow) {
  const auto machine = coarse_axis();
  Record record;
  record.logs = {recorded_elsewhere(machine)};
  const auto settings = signals_in(host::RowBand::usual, record.logs);
  const auto& axis = machine.axes.front();
  measure(record, axis, settings);
  const auto motion = drive(record, machine, 0);
  ASSERT_FALSE(motion.empty());
  regress_on(record, motion, axis, settings);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  const Eigen::VectorXd noise = Eigen::VectorXd::NullaryExpr(record.target.size(), [&] {
                                  return normal(random);
                                }).cwiseProduct(record.regressors.counts());
  std::vector<EffectResponse> responses;
  responses.emplace_back(machine, 0, record.driven, settings, FrictionAlong::own_motion);
  SearchContext context;
  context.axis = axis;
  context.signals = settings;
  context.reversals = 8;
  Term term;
  term.candidate = *candidate_index(sim::id_of<sim::PreslidingHysteresis>());
  term.shape = 1e-8;
  term.coefficients = Eigen::VectorXd::Constant(1, 1e-8);
  term.covariance = Eigen::MatrixXd::Constant(1, 1, 1e-18);
  term.nats = 200.0;
  const auto description = describe_in_closed_loop({term}, {}, responses, record.regressors, noise, noise, context);
  EXPECT_TRUE(description.terms.empty());
  EXPECT_TRUE(description.findings.empty());
  EXPECT_EQ(description.remainders.size(), 1U);
}

// Runs have linear axes; what they move is shown in units of the axis itself, here a joint whose radian is 0.25 m long.
TEST(OwnRuns, MoveParametersInTheUnitsOfTheAxis) {
  auto machine = coarse_axis();
  auto& axis = machine.axes.front();
  axis.coordinate = {machine::AxisKind::rotary, 0.25};
  axis.encoder.increment = 0.0;
  Record record;
  record.logs = {recorded_elsewhere(machine)};
  const auto settings = signals_in(host::RowBand::usual, record.logs);
  measure(record, axis, settings);
  const auto motion = drive(record, machine, 0);
  ASSERT_FALSE(motion.empty());
  regress_on(record, motion, axis, settings);
  std::vector<EffectResponse> responses;
  responses.emplace_back(machine, 0, record.driven, settings, FrictionAlong::own_motion);
  const double mass = 1.03 * axis.mass, found = 1.01 * axis.mass;
  const std::vector<machine::Effect> hidden{sim::effect_of<sim::MassMismatch>({.mass = mass})};
  const Eigen::VectorXd target =
      record.regressors.stacked([&](const Motion& one) { return responses[0].together(one, hidden); });
  SearchContext context;
  context.axis = axis;
  context.signals = settings;
  Term term;
  term.candidate = *candidate_index(sim::id_of<sim::MassMismatch>());
  term.coefficients = Eigen::VectorXd::Constant(1, found - axis.mass);
  term.covariance = Eigen::MatrixXd::Constant(1, 1, std::pow(1e-3 * axis.mass, 2));
  Finding finding(sim::id_of<sim::MassMismatch>());
  finding.axis = axis.name;
  candidates()[term.candidate].describe(context, 0.0, term.coefficients, term.covariance, finding);
  const Eigen::VectorXd left = target * (mass - found) / (mass - axis.mass);
  const auto refined = refine_in_closed_loop({finding}, {&term, 1}, responses, record.regressors, target, left, context)
                           .findings.front();
  EXPECT_NEAR(refined.values.at("mass")[0], mass, 1e-3 * mass);
  ASSERT_EQ(refined.parameters.front().unit, "kg m^2");
  EXPECT_NEAR(refined.parameters.front().values[0], mass * 0.25 * 0.25, 1e-3 * mass * 0.25 * 0.25);
  EXPECT_LT(refined.parameters.front().standard_errors[0], 2e-3 * mass * 0.25 * 0.25);
}

// The fastest motion of an axis without set-points is the loop's answer to what disturbs it, in which a mode would
// live.
TEST(OwnRuns, AskForNoModeWhereTheMotionIsDisturbed) {
  SearchContext context;
  context.axis = coarse_axis().axes.front();
  context.log_period = 1e-3;
  const auto& mode = candidates()[*candidate_index(sim::id_of<sim::StructuralResonance>())];
  EXPECT_FALSE(mode.grid(context).empty());
  context.disturbed_motion = true;
  EXPECT_TRUE(mode.grid(context).empty());
}

}  // namespace stiction::host
