// What noise alone leaves of the residual, against white noise through the band by its formula.
#include "host/diagnose/record/noise_floor.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/verdict/agreement.hpp"
#include "tests/host/diagnose/synthetic_log.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

constexpr double pi = std::numbers::pi, period = 1e-3, mass = 225.0;
constexpr double edge = 100.0;  // Hz, of the rows: 0.8 of half their rate

machine::AxisModel axis_without_noise() {
  auto axis = test::bench_machine().axes.front();
  axis.encoder.increment = axis.encoder.noise = 0.0;
  return axis;
}

// Slow sines with a force that is no whole number of anything, so that the motion has no grid.
Log record(double duration = 20.0) {
  Log log;
  log.source = "sines";
  log.period = period;
  log.axes.resize(1);
  auto& axis = log.axes.front();
  for (int k = 0; k < duration / period; ++k) {
    const double t = k * period;
    log.t.push_back(t);
    axis.x.push_back(0.03 * std::sin(2.0 * pi * 0.7 * t) + 0.011 * std::sin(2.0 * pi * 1.9 * t));
    axis.i.push_back(3.0 * std::sin(2.0 * pi * 0.7 * t + 0.3));
  }
  return log;
}

NoiseFloor floor_of(const Log& log, const machine::AxisModel& axis) {
  const auto settings = signals_in(host::RowBand::usual, {&log, 1});
  const auto rows = rows_of({log}, axis, settings);
  return noise_floor({log}, axis, settings, Eigen::VectorXd::Ones(rows.rows()), {}, expected_force(rows, axis), 1);
}

// N rms: the second derivative of white noise of `deviation` (m) up to the edge, times the mass.
double by_formula(double deviation) {
  return mass * deviation * std::sqrt(2.0 * period * std::pow(2.0 * pi, 4) * std::pow(edge, 5) / 5.0);
}

TEST(NoiseFloor, OfTheEncoderIsItsRoundingThroughTheBand) {
  for (const double increment : {1e-7, 1e-6, 2e-5}) {
    auto axis = axis_without_noise();
    axis.encoder.increment = increment;
    const auto floor = floor_of(record(), axis);
    const double wanted = by_formula(increment / std::sqrt(12.0));
    test::figure(fmt::format("noise floor of an increment of {:g} um", increment * 1e6),
                 fmt::format("{:.4g} N rms, {:.4g} N by formula (bound 25 %)", floor.encoder, wanted));
    EXPECT_NEAR(floor.encoder, wanted, 0.25 * wanted);
    EXPECT_NEAR(floor.position, increment / std::sqrt(6.0), 1e-3 * increment);
  }
}

TEST(NoiseFloor, TakesTheGridOfTheRecordWhereItIsCoarser) {
  auto axis = axis_without_noise();
  axis.encoder.increment = 1e-9;
  auto log = record();
  for (double& x : log.axes.front().x) x = std::round(x / 5e-6) * 5e-6;
  const auto floor = floor_of(log, axis);
  EXPECT_NEAR(floor.increment, 5e-6, 1e-12);
  EXPECT_NEAR(floor.encoder, by_formula(5e-6 / std::sqrt(12.0)), 0.25 * by_formula(5e-6 / std::sqrt(12.0)));
}

TEST(NoiseFloor, OfTheClockIsSpeedTimesJitter) {
  auto log = record();
  log.clock.jitter = 2e-6;
  double square = 0.0;
  for (std::size_t k = 1; k < log.t.size(); ++k)
    square += std::pow((log.axes.front().x[k] - log.axes.front().x[k - 1]) / period, 2);
  const double wanted = by_formula(2e-6 * std::sqrt(square / static_cast<double>(log.t.size())));
  EXPECT_NEAR(floor_of(log, axis_without_noise()).clock, wanted, 0.25 * wanted);
  log.clock.resampled = true;  // its samples are where their stamps say
  EXPECT_EQ(floor_of(log, axis_without_noise()).clock, 0.0);
}

TEST(NoiseFloor, OfTheCurrentIsItsWhiteNoiseInTheBand) {
  auto log = record();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (double& i : log.axes.front().i) i += 0.05 * normal(random);
  const double wanted = 94.0 * 0.05 * std::sqrt(2.0 * period * edge);
  const double found = floor_of(log, axis_without_noise()).effort;
  test::figure("noise floor of a current's noise of 50 mA",
               fmt::format("{:.4g} N rms, {:.4g} N by formula (bound 15 %)", found, wanted));
  EXPECT_NEAR(found, wanted, 0.15 * wanted);
  // A known test signal is no noise.
  auto with_test = log;
  auto& axis = with_test.axes.front();
  for (std::size_t k = 0; k < axis.i.size(); ++k) {
    axis.i_inject.push_back(normal(random));
    axis.i[k] += axis.i_inject.back();
  }
  EXPECT_NEAR(floor_of(with_test, axis_without_noise()).effort, found, 0.15 * found);
}

// As the reading step leaves it: interpolated samples have no grid any more.
TEST(NoiseFloor, KnowsTheIncrementOfARecordThatWasResampled) {
  auto log = record();
  auto& axis = log.axes.front();
  axis.increments.resize(log_channels.size());
  for (std::size_t k = 0; k < log_channels.size(); ++k)
    if (log_channels[k].values == &AxisLog::x) axis.increments[k] = 5e-6;
  EXPECT_EQ(floor_of(log, axis_without_noise()).increment, 5e-6);
}

}  // namespace
}  // namespace stiction::host
