// Noise with two spectra, one at rest and one in motion: autoregressions of known coefficients, made here.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "host/diagnose/record/redrawn_residual.hpp"
#include "host/diagnose/statistics/noise_model.hpp"

namespace stiction::host::noise_at_rest {
namespace {

constexpr Eigen::Index rows = 8000, dwell = 200;
const std::vector<std::size_t> logs{0, 3000};
const std::vector<double> at_rest = [] {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < rows; ++i) values.push_back(i / dwell % 2 == 0 ? 0.0 : 1.0);
  return values;
}();

NoiseRows two_states() {
  NoiseRows of(logs);
  of.at_rest = at_rest;
  return of;
}

// In motion white with a deviation of 1; at rest three times as large and slow.
Eigen::VectorXd noise(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const bool rest = at_rest[static_cast<std::size_t>(i)] != 0.0;
    values[i] = rest ? 0.95 * (i > 0 ? values[i - 1] : 0.0) + 3.0 * std::sqrt(1.0 - 0.95 * 0.95) * normal(random)
                     : normal(random);
  }
  return values;
}

struct State {
  double rms, correlation;  // of a row with the next
};
State state_of(const Eigen::VectorXd& values, bool rest) {
  double square = 0.0, product = 0.0, count = 0.0;
  for (Eigen::Index i = 1; i < rows; ++i) {
    if (i % dwell < 10 || (at_rest[static_cast<std::size_t>(i)] != 0.0) != rest) continue;
    square += values[i] * values[i];
    product += values[i] * values[i - 1];
    count += 1.0;
  }
  return {std::sqrt(square / count), product / square};
}

TEST(NoiseAtRest, EachStateIsMadeWhiteByItsOwnSpectrum) {
  const auto residual = noise(1);
  const Eigen::VectorXd white = noise_of(residual, two_states())(residual), alike = noise_of(residual, logs)(residual);
  for (const bool rest : {false, true}) {
    EXPECT_NEAR(state_of(white, rest).rms, 1.0, 0.1) << rest;
    // The white hundredth that the model adds to each (whitening.cpp) is a tenth of the slow one's innovations.
    EXPECT_NEAR(state_of(white, rest).correlation, 0.0, 0.1) << rest;
  }
  EXPECT_LT(state_of(alike, false).correlation, -0.2) << "one spectrum for both is neither's";
}

TEST(NoiseAtRest, TwoSpectraAreLikelierWhereThereAreTwo) {
  const auto residual = noise(2);
  EXPECT_GT(noise_log_likelihood(residual, two_states()), noise_log_likelihood(residual, logs) + 500.0);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd one = Eigen::VectorXd::NullaryExpr(rows, [&] { return normal(random); });
  EXPECT_NEAR(noise_log_likelihood(one, two_states()), noise_log_likelihood(one, logs), 20.0);
}

TEST(NoiseAtRest, TransposeAndColouringAreThoseOfWhitening) {
  const auto residual = noise(4);
  const auto whitening = noise_of(residual, two_states());
  const auto column = noise(5), other = noise(6);
  EXPECT_NEAR(whitening(column).dot(other), column.dot(whitening.transposed(other)), 1e-8 * column.norm());
  const Whitening unweighed(residual, two_states());
  const Eigen::VectorXd second = column.tail(rows - 3000);
  Eigen::VectorXd both = Eigen::VectorXd::Zero(rows);
  both.tail(rows - 3000) = unweighed.coloured(second, 3000);
  const Eigen::VectorXd back = unweighed(both).tail(rows - 3008);
  EXPECT_LT((back - second.tail(rows - 3008)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(NoiseAtRest, FewRowsOfAStateHaveTheSpectrumOfAll) {
  const auto residual = noise(7);
  std::vector<double> few(static_cast<std::size_t>(rows), 0.0);
  std::fill(few.begin() + 400, few.begin() + 600, 1.0);
  NoiseRows of(logs);
  of.at_rest = few;
  EXPECT_EQ(Whitening(residual, of)(residual), Whitening(residual, logs)(residual));
}

// N for N: what is drawn at rest is as large as what was left at rest, and the same in motion.
TEST(NoiseAtRest, DrawnForcesAreAsLargeInEachState) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(rows, 0.0, 4e-3 * static_cast<double>(rows - 1));
  const std::vector<std::size_t> start{0};
  NoiseRows one_log(start);
  one_log.at_rest = at_rest;
  const RedrawnResidual redrawn(noise(8), one_log, time, 4e-3);
  const auto drawn = redrawn.drawn(0, {time.data(), static_cast<std::size_t>(rows)}, 9);
  const Eigen::VectorXd force = Eigen::Map<const Eigen::VectorXd>(drawn.data(), rows);
  EXPECT_NEAR(state_of(force, false).rms, 1.0, 0.1);
  EXPECT_NEAR(state_of(force, true).rms, 3.0, 0.6);
}

// A dwell is rest, a reversal is not.
TEST(NoiseAtRest, RowsOfADwellAreAtRest) {
  Motion motion;
  motion.period = 1e-3;
  constexpr double pi = 3.14159265358979;
  for (int i = 0; i < 4000; ++i) {
    const double t = 1e-3 * i;  // to and fro twice, then a dwell of 1 s, then once more
    const double phase = t < 2.0 ? t : t < 3.0 ? 2.0 : t - 1.0;
    motion.t.push_back(t);
    motion.x.push_back(0.1 * (1.0 - std::cos(2.0 * pi * phase)));
    motion.v.push_back(t >= 2.0 && t < 3.0 ? 0.0 : 0.1 * 2.0 * pi * std::sin(2.0 * pi * phase));
    motion.a.push_back(t >= 2.0 && t < 3.0 ? 0.0 : 0.1 * 4.0 * pi * pi * std::cos(2.0 * pi * phase));
    motion.force.push_back(motion.a.back());
    motion.x_set.push_back(motion.x.back());
  }
  const LogRows of({motion}, {.row_rate = 250.0});
  motion.x_set.clear();
  const LogRows unknown({motion}, {.row_rate = 250.0});
  motion.x_set.assign(motion.t.size(), std::nan(""));
  const LogRows no_number({motion}, {.row_rate = 250.0});
  for (const auto* none : {&unknown, &no_number})
    EXPECT_EQ(Eigen::Map<const Eigen::VectorXd>(none->at_rest().data(), none->rows()).sum(), 0.0);
  for (Eigen::Index i = 0; i < of.rows(); ++i) {
    const double t = of.time[i];
    const double rest = of.at_rest()[static_cast<std::size_t>(i)];
    const bool in_dwell = t > 2.05 && t<2.95, near_dwell = t> 1.95 && t < 3.05;
    if (near_dwell && !in_dwell) continue;
    EXPECT_EQ(rest, in_dwell ? 1.0 : 0.0) << t;
  }
}

}  // namespace
}  // namespace stiction::host::noise_at_rest
