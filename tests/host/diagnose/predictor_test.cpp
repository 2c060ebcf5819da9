// What wanders slowly is as white behind the predictor as what changes from row to row. Truth: first-order Markov
// noise, by its difference equation, and the normal distribution.
#include "host/diagnose/statistics/predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "host/diagnose/statistics/whitening.hpp"

namespace stiction::host {
namespace {

constexpr Eigen::Index predicted_rows = 5000;  // 20 s at 250 Hz
const std::vector<std::size_t> one_log{0};

// A force of which a fifth of the square wanders with a corner of `cycles` a row and the rest with one of 0.2, beside
// white noise of a twentieth of its deviation.
Eigen::VectorXd wandering(double cycles, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto next = [&](double value, double corner) {
    const double pole = std::exp(-2.0 * std::numbers::pi * corner);
    return pole * value + std::sqrt(1.0 - pole * pole) * normal(random);
  };
  double slow = normal(random), fast = normal(random);
  return Eigen::VectorXd::NullaryExpr(predicted_rows, [&] {
    slow = next(slow, cycles), fast = next(fast, 0.2);
    return std::sqrt(0.2) * slow + std::sqrt(0.8) * fast + 0.05 * normal(random);
  });
}

Eigen::VectorXd drawn_white(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(predicted_rows, [&] { return normal(random); });
}

// Mean power of the slowest `lines` over that of all lines.
double share_below(const Eigen::VectorXd& values, int lines) {
  double power = 0.0;
  for (int k = 1; k <= lines; ++k) {
    std::complex<double> sum = 0.0;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      sum += values[i] *
             std::polar(1.0, -2.0 * std::numbers::pi * k * static_cast<double>(i) / static_cast<double>(values.size()));
    power += std::norm(sum);
  }
  return power / lines / values.squaredNorm();
}

// By eight rows alone it is 2.9.
TEST(Predictor, SlowNoiseIsWhiteBehindIt) {
  double share = 0.0;
  constexpr unsigned records = 10;
  for (unsigned record = 0; record < records; ++record) {
    const auto noise = wandering(0.3 / 250.0, record);
    share += share_below(Predictor(noise, one_log, Memory::of_spans).errors(noise), 20) / records;  // below 1 Hz
  }
  EXPECT_GT(share, 0.6);
  EXPECT_LT(share, 1.6);
}

// The weight of a constant, over what whitened rows say of its deviation: a normal number of variance 1 if they are
// right. Of 60 records the mean square is between 0.5 and 2 but for one in ten thousand; by eight rows alone it is 6.4.
TEST(Predictor, AConstantInSlowNoiseIsKnownAsWellAsItIs) {
  double mean_square = 0.0;
  constexpr unsigned records = 60;
  for (unsigned record = 100; record < 100 + records; ++record) {
    const auto noise = wandering(0.3 / 250.0, record);
    const Predictor predictor(noise, one_log, Memory::of_spans);
    const Eigen::VectorXd white = predictor.errors(noise);
    const Eigen::VectorXd constant = predictor.errors(Eigen::VectorXd::Ones(predicted_rows));
    const double variance = white.squaredNorm() / static_cast<double>(predicted_rows);
    const double z = constant.dot(white) / std::sqrt(constant.squaredNorm() * variance);
    mean_square += z * z / records;
  }
  RecordProperty("mean_square", std::to_string(mean_square));
  EXPECT_GT(mean_square, 0.5);
  EXPECT_LT(mean_square, 2.0);
}

TEST(Predictor, WhiteNoiseIsLeftAsItIs) {
  const auto noise = drawn_white(1);
  const Predictor predictor(noise, one_log, Memory::of_spans);
  EXPECT_NEAR(predictor.errors(noise).squaredNorm() / noise.squaredNorm(), 1.0, 0.01);
  for (const double cycles : {0.0, 1e-3, 0.1, 0.4}) EXPECT_NEAR(predictor.gain_square(cycles), 1.0, 0.2) << cycles;
}

TEST(Predictor, TransposeGainAndExpectationAreThoseOfItsErrors) {
  const auto noise = wandering(0.3 / 250.0, 2);
  const Predictor predictor(noise, one_log, Memory::of_spans);
  const auto one = drawn_white(3), other = drawn_white(4);
  EXPECT_NEAR(predictor.errors(one).dot(other), one.dot(predictor.transposed(other)), 1e-8 * one.norm());

  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(predicted_rows);
  impulse[0] = 1.0;
  const Eigen::VectorXd answer = predictor.errors(impulse);
  for (const double cycles : {0.0, 1e-4, 1e-2, 0.3}) {
    std::complex<double> gain = 0.0;
    for (Eigen::Index i = 0; i < predicted_rows; ++i)
      gain += answer[i] * std::polar(1.0, -2.0 * std::numbers::pi * cycles * static_cast<double>(i));
    EXPECT_NEAR(predictor.gain_square(cycles), std::norm(gain), 1e-9 * (1.0 + std::norm(gain))) << cycles;
  }

  const Eigen::VectorXd errors = predictor.errors(noise);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(predicted_rows + 1);
  for (Eigen::Index i = 0; i < predicted_rows; ++i) sums[i + 1] = sums[i] + noise[i];
  for (const Eigen::Index row : {0, 1, 8, 9, 40, 1000, 4999})
    EXPECT_NEAR(predictor.expected(static_cast<std::size_t>(row), noise, sums), noise[row] - errors[row], 1e-9) << row;
}

// A force that goes away and never comes back: what is drawn of it stays as large as it was.
TEST(Predictor, WhatItColoursStaysAsLargeAsTheNoiseItIsOf) {
  for (unsigned record = 0; record < 5; ++record) {
    const auto noise = wandering(1e-5, 200 + record);
    const Whitening whitening(noise, NoiseRows(one_log), Memory::of_spans);
    const double innovation = std::sqrt(whitening(noise).squaredNorm() / static_cast<double>(predicted_rows));
    const Eigen::VectorXd drawn = whitening.coloured(innovation * drawn_white(300 + record));
    EXPECT_LT(drawn.squaredNorm(), 10.0 * noise.squaredNorm()) << record;
  }
}

TEST(Predictor, OfSilenceExpectsNothing) {
  const Predictor predictor(Eigen::VectorXd::Zero(100), one_log, Memory::of_spans);
  EXPECT_TRUE(predictor.empty());
  EXPECT_EQ(predictor.errors(Eigen::VectorXd::Ones(100)), Eigen::VectorXd::Ones(100));
}

}  // namespace
}  // namespace stiction::host
