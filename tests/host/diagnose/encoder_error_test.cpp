// An encoder's error along the ticks of a record: its columns against the drive's answer at steady speed, the scan of
// all signal periods at once against the columns.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <random>

#include "host/diagnose/record/encoder_error_response.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/spectrum/signal_scan.hpp"
#include "host/diagnose/spectrum/wave_sums.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

constexpr double log_period = 1e-3;  // s, sixteen ticks
constexpr double cutoff = 300.0;     // Hz

machine::AxisModel drive_with(machine::VelocitySource velocity) {
  auto axis = cross_table().axes.front();
  axis.encoder.velocity = velocity;
  axis.encoder.increment = 10e-9;
  return axis;
}

host::Motion moved(const std::function<double(double)>& path, double seconds) {
  host::Motion motion;
  motion.period = log_period;
  for (double t = 0.0; t < seconds; t += log_period) {
    motion.t.push_back(t);
    motion.read.push_back(path(t));
  }
  motion.x = motion.read;
  motion.v = host::central_difference(motion.x, log_period);
  motion.a = host::central_difference(motion.v, log_period);
  motion.force.assign(motion.t.size(), 0.0);
  return motion;
}

double swings(double t) { return 0.1 * std::sin(3.0 * t) + 0.02 * std::sin(17.0 * t); }

std::vector<double> drawn_samples(std::size_t count) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> values(count);
  // At rest at both ends, where filters in both directions are their own transposes.
  for (std::size_t i = 100; i + 100 < count; ++i) values[i] = normal(random);
  return values;
}

}  // namespace

// 1.3 and 7.4 kHz at steady speed, seen in samples of 1 kHz: in amplitude and phase what the frequencies say.
TEST(EncoderError, at_a_steady_speed_is_the_answer_at_its_frequency) {
  for (const auto velocity :
       {machine::VelocitySource::ideal, machine::VelocitySource::estimated, machine::VelocitySource::mean_difference})
    for (const double frequency : {1310.0, 7390.0}) {
      const auto axis = drive_with(velocity);
      constexpr double period = 20e-6;
      const auto motion = moved([&](double t) { return frequency * period * t; }, 2.0);
      const host::SeenEncoderError seen(motion, axis, cross_table().timing, 7, cutoff);
      const auto columns = seen.columns(period);
      std::complex<double> found = 0.0;
      int count = 0;
      for (std::size_t i = 500; i < 1500; ++i, ++count)
        found += std::complex<double>(columns[0][i], columns[1][i]) *
                 std::polar(1.0, -2.0 * std::numbers::pi * motion.x[i] / period);
      found /= count;
      const auto expected = seen.response(frequency);
      EXPECT_LT(std::abs(found - expected), 0.01 * std::abs(expected)) << frequency << " Hz";
    }
}

TEST(EncoderError, weights_of_ticks_are_the_transpose_of_the_columns) {
  for (const auto velocity : {machine::VelocitySource::ideal, machine::VelocitySource::estimated}) {
    const auto motion = moved(swings, 3.0);
    const host::SeenEncoderError seen(motion, drive_with(velocity), cross_table().timing, 7, cutoff);
    const auto weight = drawn_samples(motion.t.size());
    const auto of_ticks = seen.transposed(weight);
    for (const double period : {3.1e-6, 40e-6, 700e-6}) {
      const auto columns = seen.columns(period);
      std::complex<double> direct = 0.0, by_ticks = 0.0;
      double size = 0.0;
      for (std::size_t i = 0; i < weight.size(); ++i) {
        direct += weight[i] * std::complex<double>(columns[0][i], columns[1][i]);
        size += std::abs(weight[i] * columns[0][i]);
      }
      const double order = 2.0 * std::numbers::pi / period;
      for (Eigen::Index k = 0; k < of_ticks.place.size(); ++k)
        by_ticks += std::polar(1.0, order * of_ticks.place[k]) *
                    std::complex<double>(of_ticks.position[k], order * of_ticks.slope[k]);
      EXPECT_LT(std::abs(direct - by_ticks), 1e-6 * size) << period << " m";
    }
  }
}

TEST(EncoderError, powers_of_many_orders_are_those_of_the_sums) {
  const auto place = Eigen::VectorXd::Random(300).array() * 0.1 + 0.1;
  const Eigen::VectorXd at = place, weight = Eigen::VectorXd::Random(300), slope = 1e-3 * Eigen::VectorXd::Random(300);
  constexpr double step = 0.5 / 0.2;
  host::WavePower power(step, 4000);
  power.transform(at, weight, slope);
  for (const std::size_t order : {std::size_t{1}, std::size_t{700}, std::size_t{3999}}) {
    std::complex<double> sum = 0.0;
    const double by_metre = 2.0 * std::numbers::pi * step * static_cast<double>(order);
    for (Eigen::Index i = 0; i < at.size(); ++i)
      sum += std::polar(1.0, by_metre * at[i]) * std::complex<double>(weight[i], by_metre * slope[i]);
    EXPECT_NEAR(std::sqrt(power.at(order)), std::abs(sum), 1e-4 * (300.0 + by_metre * 0.3)) << order;
  }
}

// 2 nm over 3.217 um and over 61 um, beside a white residual, in strokes at 0.3 m/s: to a part of what the way
// resolves.
TEST(EncoderError, any_signal_period_is_found_over_all_rows) {
  const auto axis = drive_with(machine::VelocitySource::ideal);
  const auto timing = cross_table().timing;
  host::SignalSettings settings;
  settings.cutoff = cutoff;
  const host::LogRows rows({moved(swings, 12.0)}, settings);
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Eigen::VectorXd noise(rows.rows());
  for (double& v : noise) v = normal(random);
  for (const double period : {3.217e-6, 61e-6}) {
    const Eigen::VectorXd error = rows.stacked([&](const host::Motion& motion) {
      return host::SeenEncoderError(motion, axis, timing, settings.difference_points, settings.cutoff)
          .columns(period)
          .front();
    });
    const Eigen::VectorXd residual =
        0.3 * error / std::sqrt(error.squaredNorm() / static_cast<double>(rows.rows())) + noise;
    const auto scan =
        host::scan_signal_periods(rows, residual, host::Whitening(residual, rows.logs()), axis, timing, settings, 1);
    ASSERT_EQ(scan.periods.size(), 1u);
    EXPECT_NEAR(1.0 / scan.periods.front(), 1.0 / period, 0.5 / scan.extent) << period << " m";
  }
}

}  // namespace stiction::test
