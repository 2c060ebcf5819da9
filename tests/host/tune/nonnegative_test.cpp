// Least squares with unknowns that must not be negative.
#include "host/tune/nonnegative.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stiction::host {
namespace {

TEST(Nonnegative, takes_the_free_minimum_where_it_is_allowed) {
  const Eigen::Matrix2d normal{{2.0, 0.5}, {0.5, 1.0}};
  const Eigen::Vector2d wanted{3.0, -1.0};
  const Eigen::VectorXd w = solve_nonnegative(normal, normal * wanted, 1);
  EXPECT_NEAR((w - wanted).norm(), 0.0, 1e-12);
}

// Kuhn and Tucker: the slope is zero where an unknown is free or positive, and points outside where it is zero.
TEST(Nonnegative, meets_the_conditions_of_the_minimum) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> any;
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(40, 12, [&] { return any(random); });
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(40, [&] { return any(random); });
    const Eigen::MatrixXd normal = a.transpose() * a;
    const Eigen::VectorXd right = a.transpose() * b;
    constexpr Eigen::Index bounded = 9;
    const Eigen::VectorXd w = solve_nonnegative(normal, right, bounded);
    const Eigen::VectorXd slope = right - normal * w;
    for (Eigen::Index k = 0; k < w.size(); ++k) {
      const bool free = k >= bounded || w[k] > 0.0;
      EXPECT_LE(slope[k], 1e-8);
      EXPECT_TRUE(!free || slope[k] > -1e-8) << slope[k];
      EXPECT_TRUE(k >= bounded || w[k] >= 0.0);
    }
  }
}

}  // namespace
}  // namespace stiction::host
