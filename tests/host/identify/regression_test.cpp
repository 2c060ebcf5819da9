// Least squares over blocks: against values that follow from how the data were made.
#include "host/identify/regression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stiction::host {
namespace {

TEST(BlockRegression, columns_that_depend_on_one_another_share_the_weight) {
  Eigen::MatrixXd columns(100, 3);
  for (int i = 0; i < 100; ++i) columns.row(i) << i, 2.0 * i, 1.0;
  const Eigen::VectorXd force = 10.0 * columns.col(0) + 3.0 * columns.col(2);
  const auto weights = BlockRegression(columns, force, {{0, 50}, {50, 100}}).solve();
  EXPECT_NEAR(weights[0] + 2.0 * weights[1], 10.0, 1e-6);
  EXPECT_NEAR(weights[2], 3.0, 1e-5);
}

TEST(BlockRegression, replicates_scatter_like_the_estimate_does) {
  // Mean of n values of unit noise: standard deviation 1/sqrt(n).
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  constexpr int n = 2000;
  Eigen::VectorXd force(n);
  for (double& f : force) f = 5.0 + normal(random);
  std::vector<RowBlock> blocks;
  for (std::size_t i = 0; i < n; i += 10) blocks.push_back({i, i + 10});
  const auto replicates = BlockRegression(Eigen::MatrixXd::Ones(n, 1), force, blocks).bootstrap(2000, 1);
  const double mean = replicates.col(0).mean();
  const double deviation = std::sqrt((replicates.col(0).array() - mean).square().mean());
  // 200 blocks give a standard deviation to 5 %, seen here in one draw of them.
  EXPECT_NEAR(deviation * std::sqrt(n), 1.0, 0.15);
}

TEST(BlockRegression, held_out_error_is_that_of_unseen_blocks) {
  // A fit of 20 columns of noise to 40 rows is exact to half on what it saw, worse than nothing on what it did not.
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd columns(40, 20);
  for (double& c : columns.reshaped()) c = normal(random);
  Eigen::VectorXd force(40);
  for (double& f : force) f = normal(random);
  std::vector<RowBlock> blocks;
  for (std::size_t i = 0; i < 40; i += 4) blocks.push_back({i, i + 4});
  const BlockRegression regression(columns, force, blocks);
  std::vector<std::size_t> all(20);
  for (std::size_t i = 0; i < 20; ++i) all[i] = i;
  const double seen = regression.residual_sum(all, regression.solve()) / 40.0;
  const std::vector<std::vector<std::size_t>> alternatives{all};
  EXPECT_LT(seen, 0.7 * force.squaredNorm() / 40.0);
  EXPECT_GT(regression.held_out(alternatives, 10), force.squaredNorm() / 40.0);
}

TEST(Blocks, correlation_length_of_filtered_noise_is_the_filters) {
  // A mean of 8 neighbours: correlation 1 - k/8, sum 1 + 2 (7/8 + ... + 1/8) = 8.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> noise(20008);
  for (double& value : noise) value = normal(random);
  Eigen::VectorXd residual(20000);
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    residual[i] = 0.0;
    for (Eigen::Index k = 0; k < 8; ++k) residual[i] += noise[static_cast<std::size_t>(i + k)];
  }
  const std::vector<std::size_t> logs{0};
  EXPECT_NEAR(correlation_length(residual, logs), 8.0, 1.0);
}

TEST(Blocks, begin_at_reversals_where_these_are_far_enough_apart_and_never_span_two_logs) {
  Eigen::VectorXd velocity(100);
  for (Eigen::Index i = 0; i < 100; ++i) velocity[i] = (i / 20) % 2 == 0 ? 1.0 : -1.0;
  const std::vector<std::size_t> logs{0, 70};
  const auto blocks = blocks_of(velocity, logs, 10);
  std::size_t next = 0;
  for (const auto& block : blocks) {
    EXPECT_EQ(block.begin, next);
    EXPECT_GE(block.end - block.begin, 10u);
    EXPECT_FALSE(block.begin < 70 && block.end > 70);
    next = block.end;
  }
  EXPECT_EQ(next, 100u);
  for (const std::size_t reversal : {20u, 40u, 60u})
    EXPECT_TRUE(std::any_of(blocks.begin(), blocks.end(), [&](const auto& b) { return b.begin == reversal; }));
}

TEST(NotNegative, weights_stop_at_zero_and_the_others_take_their_place) {
  // Without the bound the best weights are (2, -1); with it the second is 0 and the first the best alone: 2 - 0.8.
  Eigen::MatrixXd columns(3, 2);
  columns << 1.0, 0.8, 0.0, 0.6, 0.0, 0.0;
  const Eigen::VectorXd force = 2.0 * columns.col(0) - columns.col(1);
  const auto weights = solve_not_negative(columns, force, 0);
  EXPECT_NEAR(weights[0], 1.2, 1e-12);
  EXPECT_EQ(weights[1], 0.0);
}

}  // namespace
}  // namespace stiction::host
