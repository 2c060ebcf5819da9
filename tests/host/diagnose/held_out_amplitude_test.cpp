// What held-out rows say of a force that other rows showed.
#include "host/diagnose/judge/held_out_amplitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace stiction::host;

constexpr Eigen::Index rows = 4000, cut = 1500;  // two logs
const std::vector<std::size_t> logs{0, cut};

std::vector<RowBlock> blocks_of(std::size_t length) {
  std::vector<RowBlock> blocks;
  for (std::size_t begin = 0; begin + length <= rows; begin += length) blocks.push_back({begin, begin + length});
  return blocks;
}

// As a spring's force on a slow way.
Eigen::VectorXd slow_force() {
  Eigen::VectorXd force(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    force[i] = std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 500.0) +
               0.7 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / 333.0);
  return force;
}

// Of variance 1, which keeps its sign for about `length` rows.
Eigen::VectorXd noise(double length, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double decay = std::exp(-1.0 / length);
  Eigen::VectorXd values(rows);
  double value = normal(random);
  for (double& v : values) v = value = decay * value + std::sqrt(1.0 - decay * decay) * normal(random);
  return values;
}

}  // namespace

// 400 draws: a mean of squares of 1 is known to 7 %; blocks shorter than the noise is slow would call it less.
TEST(HeldOutAmplitude, standard_error_knows_how_slow_the_noise_is) {
  const auto force = slow_force();
  for (const double length : {1.0, 20.0, 100.0}) {
    constexpr int draws = 400;
    double mean = 0.0, square = 0.0;
    for (int k = 0; k < draws; ++k) {
      const auto found = repetition_of(force, force + 2.0 * noise(length, 1000 + k), logs, blocks_of(50));
      mean += (found.size - 1.0) / draws;
      square += std::pow((found.size - 1.0) / found.deviation, 2) / draws;
    }
    EXPECT_NEAR(mean, 0.0, 0.05) << length;
    EXPECT_GT(square, 0.6) << length;
    EXPECT_LT(square, 1.3) << length;
  }
}

TEST(HeldOutAmplitude, speaks_against_what_is_not_there_and_for_what_is) {
  const auto force = slow_force(), left = Eigen::VectorXd(noise(20.0, 1));
  EXPECT_GT(repetition_of(force, left, logs, blocks_of(50)).against(), 6.0);
  EXPECT_LT(repetition_of(force, force + left, logs, blocks_of(50)).against(), -6.0);
  // A force that these rows drown says little either way.
  EXPECT_LT(std::abs(repetition_of(0.005 * force, left, logs, blocks_of(50)).against()), 1.0);
}

TEST(HeldOutAmplitude, may_be_all_but_in_one_percent_of_records) {
  EXPECT_TRUE((HeldOutAmplitude{0.4, 0.35}.may_be_all()));
  EXPECT_FALSE((HeldOutAmplitude{0.4, 0.25}.may_be_all()));
  EXPECT_TRUE((HeldOutAmplitude{1.5, 0.01}.may_be_all()));
}

TEST(HeldOutAmplitude, of_a_force_that_does_not_act_says_nothing) {
  const auto found = repetition_of(Eigen::VectorXd::Zero(rows), noise(1.0, 1), logs, blocks_of(50));
  EXPECT_EQ(found.deviation, 0.0);
  EXPECT_EQ(found.against(), 0.0);
}
