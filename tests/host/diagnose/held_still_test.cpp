// Records that creep where the run of a file without a contact holds still, by arithmetic; and what is named of one.
#include "host/diagnose/record/held_still.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/standstill.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/host/diagnose/dwelling_record.hpp"
#include "tests/host/diagnose/synthetic_log.hpp"

namespace stiction::host {
namespace {

constexpr double departs = 1.0, slides = 1.2;         // s
constexpr double creep = 1e-3, acceleration = 0.5;    // m/s, m/s^2
constexpr double holding = 12.0, coulomb = 20.0;      // N, of the run at standstill; of the file
constexpr double crept = creep * (slides - departs);  // m

// 50 kg against 20 N.
machine::AxisModel creeping_axis() {
  auto axis = test::bench_machine().axes.front();
  axis.mass = 50.0;
  axis.encoder.increment = axis.encoder.noise = 0.0;
  axis.friction.use = "coulomb_viscous";
  sim::set_parameters<sim::CoulombViscous<>>(axis.friction, {coulomb, 100.0});
  return axis;
}

// At rest, at 1 mm/s from `from` on, faster and faster from 1.2 s on; the motor with 12 N.
Log departing(double from) {
  Log log;
  log.source = "departs";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  for (int k = 0; k < 2000; ++k) {
    const double t = 1e-3 * k, sliding = std::max(t - slides, 0.0);
    log.t.push_back(t);
    axis.x.push_back(creep * std::max(t - from, 0.0) + 0.5 * acceleration * sliding * sliding);
    axis.force.push_back(holding);
  }
  return log;
}

struct Both {
  explicit Both(const Log& record, const Log& run)
      : axis(creeping_axis()),
        logs{record},
        settings(signals_in(host::RowBand::usual, logs)),
        measured(rows_of(logs, axis, settings)),
        runs(rows_of({run}, axis, settings)),
        beside(logs, measured, axis, settings) {}

  machine::AxisModel axis;
  std::vector<Log> logs;
  SignalSettings settings;
  LogRows measured, runs;
  RecordsBesideRuns beside;
};

double mean_between(const LogRows& rows, const Eigen::VectorXd& values, double from, double to) {
  double sum = 0.0;
  int count = 0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (rows.time[i] > from && rows.time[i] < to) sum += values[i], ++count;
  return sum / count;
}

}  // namespace

// The run holds still with 12 N until the record has crept for 0.2 s.
TEST(HeldStill, LeavesTheRecordAloneWhereItCreeps) {
  const Both both(departing(departs), departing(slides));
  const auto left = both.beside.left_of(both.runs);
  EXPECT_NEAR(mean_between(both.runs, left, 1.07, 1.13), 0.0, 0.01);
  EXPECT_NEAR(mean_between(both.runs, left, 0.3, 0.9), holding, 0.01);  // both stand, and no row of this counts
  const auto moving = both.beside.moving(both.runs);
  EXPECT_EQ(mean_between(both.runs, moving, 1.07, 1.13), 1.0);
  EXPECT_EQ(mean_between(both.runs, moving, 0.3, 0.9), 0.0);
  EXPECT_EQ(mean_between(both.runs, moving, 1.4, 1.8), 1.0);
}

// Columns know the creep's speed, and a contact the whole way, although the positions differ by it from there on.
TEST(HeldStill, JoinsTheMotionsByTheirDisplacements) {
  const Both both(departing(departs), departing(slides));
  const auto joined = both.beside.joined_motion(both.runs);
  EXPECT_NEAR(mean_between(joined, joined.velocity, 1.07, 1.13), creep, 1e-5);
  const auto &motion = joined.motions().front(), &record = both.measured.motions().front();
  const double way = std::accumulate(motion.moved.begin(), motion.moved.end(), 0.0);
  EXPECT_NEAR(way, record.x.back() - record.x.front(), 0.35 * crept);  // less what is nearer than the filter reaches
  EXPECT_GT(way, both.runs.motions().front().x.back() + 0.5 * crept);
}

// Friction of the file along the creep is the same in both.
TEST(HeldStill, HasNoFrictionOffWhereTheRecordIsAlone) {
  const Both both(departing(departs), departing(slides));
  const auto off = both.beside.friction_off(both.runs, both.beside.joined_motion(both.runs));
  EXPECT_NEAR(mean_between(both.runs, off, 1.07, 1.13), 0.0, 1e-6);
}

// Two departures a millisecond apart are of the same friction: noise makes as much.
TEST(HeldStill, IsNothingOfALateStart) {
  const Both both(departing(slides - 0.001), departing(slides));
  const Eigen::VectorXd as_ever = moving_rows(both.measured, both.axis, both.settings.cutoff)
                                      .cwiseProduct(moving_rows(both.runs, both.axis, both.settings.cutoff));
  EXPECT_EQ(both.beside.moving(both.runs), as_ever);
}

// An encoder that chatters by a micrometre about a standstill tells no direction.
TEST(HeldStill, IsNothingOfAnEncodersNoise) {
  auto record = departing(slides);
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1e-6);
  for (double& x : record.axes.front().x) x += noise(random);
  const Both both(record, departing(slides));
  const auto alone =
      of_record_alone(moves_of_record(both.logs[0], both.measured.motions()[0], both.axis, both.settings.cutoff),
                      both.runs.motions()[0], both.settings.cutoff);
  EXPECT_EQ(std::accumulate(alone.begin(), alone.begin() + 1180, 0.0), 0.0);
}

// The machine has a contact of 40 um, its file none.
TEST(HeldStill, NamesPreslidingBehindDwells) {
  DiagnoseInput input;
  input.machine = test::rigid_machine();
  input.next_measurement = false;
  auto truth = input.machine;
  const double level = sim::parameters_of<sim::CoulombViscous<>>(truth.axes.front().friction).coulomb;
  truth.axes.front().effects.push_back(
      {"presliding_hysteresis", {{"stiffness", {level * std::log(10.0) / 40e-6}}, {"distance", {40e-6}}}});
  const std::vector logs{test::dwelling("slow", 3e-3, 0.4), test::dwelling("quick", 8e-3, 0.3),
                         test::dwelling("other", 5e-3, 0.35)};
  const auto records = without_noise(truth, 0, logs).replayed;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    auto record = records[k];
    record.source = logs[k].source;
    (k < 2 ? input.logs : input.held_out).push_back(record);
  }
  const auto verdict = diagnose(input);
  ASSERT_FALSE(verdict.findings.empty());
  EXPECT_EQ(verdict.findings.front().effect->name, "presliding_hysteresis");
  EXPECT_NEAR(verdict.findings.front().values.at("distance").front(), 40e-6, 8e-6);
}

}  // namespace stiction::host
