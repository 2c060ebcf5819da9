#include "host/diagnose/statistics/marginal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/diagnose/statistics/noise_model.hpp"

namespace stiction::host {
namespace {

constexpr Eigen::Index rows = 60;

Eigen::VectorXd drawn(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd values(rows);
  for (double& each : values) each = normal(random);
  return values;
}

// Log density of normal rows with covariance I + B S B', less that of white ones: by the covariance itself.
double by_covariance(const Eigen::VectorXd& target, const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviation) {
  const Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(rows, rows) + columns * deviation.cwiseAbs2().asDiagonal() * columns.transpose();
  const double squares = target.dot(covariance.fullPivLu().solve(target));
  return 0.5 * (target.squaredNorm() - squares - std::log(covariance.determinant()));
}

struct Rows {
  Eigen::VectorXd target;
  Eigen::MatrixXd columns;
  Evidence evidence;

  explicit Rows(std::uint64_t seed) : Rows(std::mt19937_64(seed)) {}

 private:
  explicit Rows(std::mt19937_64 random)
      : target(drawn(random)), columns(rows, 5), evidence(target, {{0, 20}, {20, rows}}) {
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      columns.col(k) = drawn(random);
      evidence.add({columns.col(k)});
    }
  }
};

TEST(Marginal, IsTheDensityOfRowsWithTheGroupsCovariance) {
  Rows r(1);
  const double size = 0.7;
  const Group group{{0, 1, 2}, Eigen::Vector3d(1.0, 0.4, 2.0)};
  const Posterior none(r.evidence, {size, size});
  EXPECT_NEAR(none.gain_of(group).nats, by_covariance(r.target, r.columns.leftCols(3), size * group.deviation), 1e-9);
}

TEST(Marginal, AddsUpGroupByGroup) {
  Rows r(2);
  const double size = 1.3;
  const Group first{{0, 1, 2}, Eigen::Vector3d(1.0, 0.4, 2.0)}, second{{3, 4}, Eigen::Vector2d(0.5, 1.5)};
  Posterior both(r.evidence, {size, size});
  both.add(first);
  both.add(second);
  Eigen::VectorXd deviation(5);
  deviation << first.deviation, second.deviation;
  EXPECT_NEAR(both.nats(), by_covariance(r.target, r.columns, size * deviation), 1e-9);
}

TEST(Marginal, WeightsOfOneMoreAreThoseThatItHasOnceAdded) {
  Rows r(3);
  const Group first{{0, 1}, Eigen::Vector2d(1.0, 0.4)}, second{{2, 3}, Eigen::Vector2d(0.5, 1.5)};
  Posterior both(r.evidence, {0.5, 0.5});
  both.add(first);
  const auto foreseen = both.weights_with(second, 0.5);
  both.add(second);
  EXPECT_NEAR((foreseen - both.weights()).norm(), 0.0, 1e-12);
}

// Whoever measures in millimetres gets the same evidence.
TEST(Marginal, DoesNotDependOnTheUnitOfAWeight) {
  Rows r(4);
  const Posterior none(r.evidence, {0.1, 10.0});
  Evidence other(r.target, {{0, 20}, {20, rows}});
  other.add({1e3 * r.columns.col(0)});
  const Posterior of_other(other, {0.1, 10.0});
  EXPECT_NEAR(none.gain_of({{0}, Eigen::VectorXd::Constant(1, 1.0)}).nats,
              of_other.gain_of({{0}, Eigen::VectorXd::Constant(1, 1e-3)}).nats, 1e-9);
}

TEST(NoiseModel, MakesRowsOfVarianceOneAndLooksPastAnOddOne) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd noise(4000);
  double slow = 0.0;
  for (double& each : noise) each = slow = 0.9 * slow + 3.0 * normal(random);
  const std::vector<std::size_t> logs{0};
  const Eigen::VectorXd white = noise_of(noise, logs)(noise);
  EXPECT_NEAR(white.squaredNorm() / 4000.0, 1.0, 0.1);
  auto hit = noise;
  hit[2000] += 1000.0;
  const Eigen::VectorXd after = noise_of(hit, logs)(hit);
  EXPECT_LT(after.cwiseAbs().maxCoeff(), 30.0);
}

}  // namespace
}  // namespace stiction::host
