// Rows that stand, and those beside them that have a share in it.
#include "host/identify/standstill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/diagnose/record/record_rows.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/dahl.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/host/diagnose/synthetic_log.hpp"

namespace stiction::test {
namespace {

// 50 kg against 20 N: slower than 0.64 mm/s friction stops it within a hundredth of a second.
machine::AxisModel rigid_axis() {
  auto axis = bench_machine().axes.front();
  axis.mass = 50.0;
  axis.friction.use = "coulomb_viscous";
  sim::set_parameters<sim::CoulombViscous<>>(axis.friction, {20.0, 100.0});
  return axis;
}

// 0.1 m/s, at rest from 1 s to 1.5 s, with 2 m/s^2 before and behind.
host::Log stopping() {
  host::Log log;
  log.source = "stopping";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  double x = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double t = 1e-3 * k, from_rest = std::max(1.0 - t, t - 1.5);
    log.t.push_back(t);
    axis.x.push_back(x);
    axis.i.push_back(0.0);
    x += 1e-3 * std::clamp(2.0 * from_rest, 0.0, 0.1);
  }
  return log;
}

}  // namespace

TEST(Standstill, LeavesOutWhatStandsAsFarAsTheFilterReaches) {
  const auto axis = rigid_axis();
  const std::vector<host::Log> logs{stopping()};
  const auto settings = host::signals_in(host::RowBand::usual, logs);
  const auto rows = host::rows_of(logs, axis, settings);
  const auto moves = host::moving_rows(rows, axis, settings.cutoff);
  const double reach = 2.0 / settings.cutoff, row = rows.period(0);
  int at_rest = 0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double before = 1.0 - rows.time[i], behind = rows.time[i] - 1.5;  // s, from the rest
    if (before < reach - 2.0 * row && behind < reach - 2.0 * row) {
      EXPECT_EQ(moves[i], 0.0) << rows.time[i];
      ++at_rest;
    } else if (before > reach + 0.02 || behind > reach + 0.02) {  // the filter's own blur of the stop
      EXPECT_EQ(moves[i], 1.0) << rows.time[i];
    }
  }
  EXPECT_GT(at_rest, 100);
}

TEST(Standstill, OfALawWithAContactCountsLikeMotion) {
  const auto axis = bench_machine().axes.front();
  const std::vector<host::Log> logs{stopping()};
  const auto settings = host::signals_in(host::RowBand::usual, logs);
  const auto moves = host::moving_rows(host::rows_of(logs, axis, settings), axis, settings.cutoff);
  EXPECT_EQ(moves.minCoeff(), 1.0);
}

// Dahl's contact has a hundredth of its start left where exp(-stiffness s / level) has fallen to that.
TEST(Standstill, CountsAContactFromItsFirstSlideOn) {
  auto axis = bench_machine().axes.front();
  const sim::DahlParameters contact{20.0, 2e4, 100.0};  // N, N/m, N s/m
  axis.friction.use = "dahl";
  sim::set_parameters<sim::Dahl<>>(axis.friction, contact);
  const double forgotten = contact.coulomb / contact.stiffness * std::log(100.0);  // 4.6 mm
  auto shivering = stopping();
  for (std::size_t k = 0; k < shivering.t.size(); ++k)
    shivering.axes.front().x[k] = 0.5 * forgotten * std::sin(0.01 * static_cast<double>(k));
  const std::vector<host::Log> logs{stopping(), shivering};
  const auto settings = host::signals_in(host::RowBand::usual, logs);
  const auto rows = host::rows_of(logs, axis, settings);
  const auto counts = host::rows_after_first_slide(rows, axis);
  const auto second = static_cast<Eigen::Index>(rows.logs()[1]);
  for (Eigen::Index i = 0; i < second; ++i) {
    const double way = 0.1 * rows.time[i];  // m
    if (std::abs(way - forgotten) < 0.1 * forgotten) continue;
    EXPECT_EQ(counts[i], way > forgotten ? 1.0 : 0.0) << rows.time[i];
  }
  EXPECT_EQ(counts.tail(rows.rows() - second).minCoeff(), 1.0);  // it never slides
  EXPECT_EQ(host::rows_after_first_slide(rows, rigid_axis()).minCoeff(), 1.0);
}

}  // namespace stiction::test
