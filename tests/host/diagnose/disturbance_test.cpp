// Forces with a residual's spectrum, what runs under them have in common, and how well a weight is known by leaving
// clusters out.
#include "host/diagnose/record/disturbance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/diagnose/statistics/coherent_mean.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/diagnose/statistics/fisher.hpp"

namespace stiction::test {
namespace {

using host::CoherentMean;
using host::Disturbance;
using host::Evidence;

// A force of 2 N that wanders with a correlation of 0.9 from row to row.
Eigen::VectorXd wandering(Eigen::Index rows, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 2.0 * std::sqrt(1.0 - 0.81));
  Eigen::VectorXd force(rows);
  double value = 0.0;
  for (double& f : force) f = value = 0.9 * value + normal(random);
  return force;
}

double correlation(const std::vector<double>& x, std::size_t lag) {
  double square = 0.0, product = 0.0;
  for (std::size_t i = lag; i < x.size(); ++i) {
    square += x[i] * x[i];
    product += x[i] * x[i - lag];
  }
  return product / square;
}

TEST(Disturbance, IsAsStrongAndAsSlowAsTheResidualAndAnotherOneForEachSeed) {
  constexpr double period = 4e-3;
  const std::vector<std::size_t> logs{0, 10000};
  const Disturbance disturbance(wandering(20000, 1), logs, period);
  std::vector<double> t;
  for (int i = 0; i < 20000; ++i) t.push_back(3.0 + period * i);
  const auto first = disturbance.drawn(t, 1), second = disturbance.drawn(t, 2);
  double square = 0.0, product = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    square += first[i] * first[i] / static_cast<double>(t.size());
    product += first[i] * second[i] / static_cast<double>(t.size());
  }
  // 20 000 rows with a correlation of 0.9 are a thousand independent ones: 2 % of the deviation, each of two ways.
  EXPECT_NEAR(std::sqrt(square), 2.0, 0.15);
  EXPECT_NEAR(correlation(first, 1), 0.9, 0.02);
  EXPECT_NEAR(correlation(first, 5), std::pow(0.9, 5), 0.06);
  EXPECT_NEAR(product, 0.0, 0.5);
  EXPECT_EQ(first, disturbance.drawn(t, 1));
}

// What bursts is an effect that the noise goes on beside.
TEST(Disturbance, OfBurstsIsAsStrongAsWhatIsBetweenThem) {
  constexpr double period = 4e-3;
  auto residual = wandering(20000, 1);
  for (Eigen::Index i = 0; i < residual.size(); ++i)
    if (i % 1000 < 300) residual[i] += 40.0 * std::sin(0.5 * static_cast<double>(i));
  const std::vector<std::size_t> logs{0, 10000};
  std::vector<double> t;
  for (int i = 0; i < 20000; ++i) t.push_back(period * i);
  double square = 0.0;
  for (const double force : Disturbance(residual, logs, period).drawn(t, 1)) square += force * force;
  // The quieter half of the pieces is less than their mean: pieces of 62 rows hold three independent ones.
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(t.size())), 1.75, 0.25);
}

// Rows of 0 do not count: the axis stood there for two seconds of three.
TEST(Disturbance, IsAsStrongAsTheResidualWhereTheAxisMoves) {
  constexpr double period = 4e-3;
  auto residual = wandering(30000, 1);
  for (Eigen::Index i = 0; i < residual.size(); ++i)
    if (i % 750 < 500) residual[i] = 0.0;
  const std::vector<std::size_t> logs{0, 15000};
  std::vector<double> t;
  for (int i = 0; i < 20000; ++i) t.push_back(period * i);
  const Disturbance disturbance(residual, logs, period);
  double square = 0.0;
  for (const double force : disturbance.drawn(t, 1)) square += force * force;
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(t.size())), 2.0, 0.2);
  EXPECT_NEAR(disturbance.mean_square(), 4.0, 0.4);
}

TEST(Disturbance, OfNothingIsNone) {
  EXPECT_FALSE(Disturbance());
  const std::vector<double> t{0.0, 1e-3};
  EXPECT_EQ(Disturbance().drawn(t, 1), (std::vector{0.0, 0.0}));
}

// Runs of a slow wave, each with fast chance of three times its size: what least squares finds of the wave in a record
// with chance of its own.
class WavesWithChance : public testing::Test {
 protected:
  static constexpr std::size_t samples = 8000;
  std::vector<double> run(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 3.0 * std::numbers::sqrt2 / 2.0);
    std::vector<double> values(samples);
    for (std::size_t i = 0; i < samples; ++i)
      values[i] = std::sin(2.0 * std::numbers::pi * 0.01 * static_cast<double>(i)) + normal(random);
    return values;
  }
  static double weight(const std::vector<double>& column, const std::vector<double>& record) {
    double square = 0.0, product = 0.0;
    for (std::size_t i = 0; i < samples; ++i) {
      square += column[i] * column[i];
      product += column[i] * record[i];
    }
    return product / square;
  }
};

// The mean of n runs with a variance of 4.5 each: two of them know it to a few percent from 4000 lines of their
// spectrum.
TEST_F(WavesWithChance, ChanceOfTheirMeanFallsWithTheirNumber) {
  CoherentMean part;
  part.add(run(1));
  EXPECT_EQ(part.chance(), 0.0);
  for (std::uint64_t n = 2; n <= 4; ++n) {
    part.add(run(n));
    EXPECT_NEAR(part.chance(), 4.5 / static_cast<double>(n), 0.1 * 4.5 / static_cast<double>(n)) << n;
  }
}

TEST_F(WavesWithChance, TheMeanAloneGivesAWeightThatIsTooSmallWhatIsCommonDoesNot) {
  CoherentMean part;
  std::vector<double> mean(samples, 0.0);
  for (std::uint64_t r = 0; r < 3; ++r) {
    const auto each = run(r);
    part.add(each);
    for (std::size_t i = 0; i < samples; ++i) mean[i] += each[i] / 3.0;
  }
  const auto record = run(99);
  EXPECT_NEAR(weight(mean, record), 0.5 / (0.5 + 4.5 / 3.0), 0.06);
  // The wave's band holds 26 lines of chance beside it: 0.3 % of 9 times the wave's square over 3 runs.
  EXPECT_NEAR(weight(part.estimate(), record), 1.0, 0.05);
}

TEST_F(WavesWithChance, OneRunIsTakenAsItIs) {
  CoherentMean part;
  const auto only = run(1);
  part.add(only);
  EXPECT_EQ(part.estimate(), only);
}

TEST(Evidence, JackknifeIsTheSpreadOfWeightsWithEachClusterLeftOut) {
  constexpr Eigen::Index rows = 600, length = 60;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd columns(rows, 2);
  Eigen::VectorXd target(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    columns(i, 0) = i < 2 * length ? 1.0 : 0.01 * normal(random);  // two clusters bear on it
    columns(i, 1) = normal(random);
    target[i] = 3.0 * columns(i, 0) - columns(i, 1) + normal(random);
  }
  std::vector<host::RowBlock> blocks;
  for (Eigen::Index b = 0; b < rows / length; ++b)
    blocks.push_back({static_cast<std::size_t>(b * length), static_cast<std::size_t>((b + 1) * length)});
  Evidence evidence(target, blocks);
  evidence.add({columns.col(0), columns.col(1)});
  const auto coefficients = evidence.fit({0, 1}).coefficients;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, 2);
  for (const auto& block : blocks) {
    Eigen::VectorXd use = Eigen::VectorXd::Ones(rows);
    use.segment(static_cast<Eigen::Index>(block.begin), length).setZero();
    const Eigen::VectorXd off =
        (use.asDiagonal() * columns).colPivHouseholderQr().solve(use.cwiseProduct(target)) - coefficients;
    expected += off * off.transpose() * static_cast<double>(blocks.size() - 1) / static_cast<double>(blocks.size());
  }
  const auto [covariance, clusters] = evidence.jackknife({0, 1}, coefficients);
  EXPECT_TRUE(covariance.isApprox(expected, 1e-9)) << covariance << "\n\n" << expected;
  EXPECT_GT(covariance(0, 0), evidence.covariance({0, 1}, coefficients)(0, 0));
  EXPECT_NEAR(clusters[0], 2.0, 0.05);
  EXPECT_GT(clusters[1], 8.0);
}

// A column that acts in 5 of 40 clusters, beside a record's offset, in white noise.
TEST(Evidence, IntervalsCoverWhereFewClustersBear) {
  constexpr Eigen::Index rows = 800, length = 20;
  constexpr int draws = 600;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<host::RowBlock> blocks;
  for (Eigen::Index b = 0; b < rows / length; ++b)
    blocks.push_back({static_cast<std::size_t>(b * length), static_cast<std::size_t>((b + 1) * length)});
  const Eigen::VectorXd acting = Eigen::VectorXd::NullaryExpr(
      rows, [](Eigen::Index i) { return i / length % 8 == 3 ? std::cos(0.5 * static_cast<double>(i)) : 0.0; });
  int covered = 0, by_normal = 0;
  for (int d = 0; d < draws; ++d) {
    const Eigen::VectorXd noise = Eigen::VectorXd::NullaryExpr(rows, [&] { return normal(random); });
    Evidence evidence(2.0 * acting + noise, blocks);
    evidence.add({acting, Eigen::VectorXd::Ones(rows)});
    const auto coefficients = evidence.fit({0, 1}).coefficients;
    const double off = std::abs(coefficients[0] - 2.0) / 1.959964;
    covered += off <= std::sqrt(evidence.interval_covariance({0, 1}, coefficients)(0, 0));
    by_normal += off <= std::sqrt(evidence.covariance({0, 1}, coefficients)(0, 0));
  }
  EXPECT_NEAR(covered, 0.95 * draws, 0.03 * draws);
  EXPECT_LT(by_normal, 0.90 * draws);
}

// M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, table 26.10.
TEST(StudentLimit, IsThatOfTheTables) {
  EXPECT_NEAR(host::student_limit(1.0), 12.706, 1e-3);
  EXPECT_NEAR(host::student_limit(5.0), 2.571, 1e-3);
  EXPECT_NEAR(host::student_limit(30.0), 2.042, 1e-3);
  EXPECT_NEAR(host::student_limit(1e6), 1.960, 1e-3);
}

}  // namespace
}  // namespace stiction::test
