// What the search for causes adds up in a shorter way, against the sums themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "host/diagnose/spectrum/wave_sums.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/identify/filter.hpp"

namespace {

using namespace stiction::host;
using Complex = std::complex<double>;

Eigen::VectorXd drawn(Eigen::Index size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd values(size);
  for (double& v : values) v = normal(random);
  return values;
}

Complex wave(double turns) { return std::polar(1.0, 2.0 * std::numbers::pi * turns); }

}  // namespace

// On the bins themselves, so that only the grid's own error counts: 1e-10 of all weights' sizes.
TEST(SearchSums, waves_over_a_place_are_those_of_each_row) {
  constexpr double extent = 0.2, step = 0.125 / extent;
  constexpr std::size_t highest = 300, bins = 16384;  // the next power of two above 16 bins a period of two waves
  const Eigen::Index rows = 500;
  const auto one = drawn(rows, 1), other = Eigen::VectorXd(100.0 * drawn(rows, 2).cwiseAbs2());
  Eigen::VectorXd place(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    place[i] = std::floor(static_cast<double>(i * 7919 % rows) / static_cast<double>(rows) * bins / 8) / (step * bins);
  WaveSums sums(step, 2.0 * step * static_cast<double>(highest));
  sums.transform(place, one, other);
  const auto phase = sums.one(0) / std::abs(sums.one(0)) * (one.sum() < 0.0 ? -1.0 : 1.0);
  EXPECT_NEAR(std::abs(phase - 1.0), 0.0, 1e-9);
  for (const std::size_t order : {std::size_t{0}, std::size_t{8}, std::size_t{77}, highest - 1}) {
    Complex single = 0.0, twice = 0.0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      single += one[i] * wave(step * static_cast<double>(order) * place[i]);
      twice += other[i] * wave(2.0 * step * static_cast<double>(order) * place[i]);
    }
    // Their sizes, and the phase of one against the other: where the place begins is not told.
    const auto found = sums.one(order), found_twice = sums.other(2 * order);
    EXPECT_NEAR(std::abs(found), std::abs(single), 1e-9 * one.lpNorm<1>());
    EXPECT_NEAR(std::abs(found_twice), std::abs(twice), 1e-9 * other.lpNorm<1>());
    EXPECT_NEAR(std::abs(found * found * std::conj(found_twice) - single * single * std::conj(twice)), 0.0,
                1e-8 * std::norm(single) * std::abs(twice) + 1e-9 * std::pow(one.lpNorm<1>(), 2) * other.lpNorm<1>());
  }
}

TEST(SearchSums, several_columns_are_filtered_to_the_bit_as_each_by_itself) {
  const auto lowpass = chebyshev(8, 0.05, 0.2);
  for (const std::size_t count : {1U, 2U, 4U, 7U}) {
    std::vector<std::vector<double>> columns;
    std::vector<std::span<const double>> views;
    for (std::size_t c = 0; c < count; ++c) {
      const auto values = drawn(1000, 10 + c);
      columns.emplace_back(values.begin(), values.end());
    }
    for (const auto& column : columns) views.emplace_back(column);
    const auto together = filter_both_ways(lowpass, views, 24);
    ASSERT_EQ(together.size(), count);
    for (std::size_t c = 0; c < count; ++c) EXPECT_EQ(together[c], filter_both_ways(lowpass, views[c], 24));
  }
}

// Added in two parts, whitened in between and cut again: the products that are kept belong to the columns of now.
TEST(SearchSums, a_fit_is_that_of_the_rows_whatever_was_asked_before) {
  const Eigen::Index rows = 400;
  const auto target = drawn(rows, 20);
  const std::vector<std::size_t> logs{0};
  Evidence evidence(target, {{0, 100}, {100, 250}, {250, 400}});
  const auto a = drawn(rows, 21), b = drawn(rows, 22), c = drawn(rows, 23);
  const auto direct = [&](const std::vector<Eigen::VectorXd>& columns, const Whitening& whitening) {
    Eigen::MatrixXd all(rows, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = whitening(columns[k]);
    const Eigen::VectorXd white = whitening(target);
    return (white - all * all.householderQr().solve(white)).squaredNorm();
  };
  const double tolerance = 1e-12 * target.squaredNorm();  // rounding
  evidence.add({a, b});
  EXPECT_NEAR(evidence.fit({0, 1}).left, direct({a, b}, {}), tolerance);
  const Whitening whitening(target + 2.0 * a, logs);
  evidence.whiten(whitening);
  evidence.add({c});
  EXPECT_NEAR(evidence.fit({2, 0}).left, direct({c, a}, whitening), tolerance);
  evidence.truncate(1);
  evidence.add({c});
  EXPECT_NEAR(evidence.fit({0, 1}).left, direct({a, c}, whitening), tolerance);
  EXPECT_NEAR(evidence.fit({0, 1}, {true, true, true}).left, evidence.fit({0, 1}).left, tolerance);
}

TEST(SearchSums, another_target_has_the_products_of_its_own) {
  const Eigen::Index rows = 600;
  std::vector<RowBlock> blocks{{0, 200}, {200, 450}, {450, 600}};
  const auto one = drawn(rows, 1), other = drawn(rows, 2), column = drawn(rows, 3), late = drawn(rows, 4);
  Evidence evidence(one, blocks), direct(other, blocks);
  evidence.add({column, late});
  direct.add({column, late});
  EXPECT_NE(evidence.fit({0}).coefficients[0], direct.fit({0}).coefficients[0]);
  evidence.retarget(other);  // one product is known already, the other is not
  EXPECT_EQ(evidence.total(), direct.total());
  EXPECT_EQ(evidence.fit({0, 1}).coefficients, direct.fit({0, 1}).coefficients);
  EXPECT_EQ(evidence.held_out({0, 1}), direct.held_out({0, 1}));
}

TEST(SearchSums, columns_that_stay_or_take_the_place_of_others_have_their_own_products) {
  const Eigen::Index rows = 400;
  const auto target = drawn(rows, 30);
  const auto a = drawn(rows, 31), b = drawn(rows, 32), c = drawn(rows, 33), d = drawn(rows, 34);
  Evidence evidence(target, {{0, 100}, {100, 250}, {250, 400}});
  const auto expect = [&](const std::vector<Eigen::VectorXd>& columns) {
    const double tolerance = 1e-12 * static_cast<double>(rows);  // rounding
    ASSERT_EQ(evidence.columns(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto one = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(evidence.moment(one), target.dot(columns[i]), tolerance);
      for (std::size_t j = 0; j < columns.size(); ++j)
        EXPECT_NEAR(evidence.product(one, static_cast<Eigen::Index>(j)), columns[i].dot(columns[j]), tolerance);
    }
  };
  evidence.add({a, b, c});
  evidence.ask_for({0, 1}, {2});
  expect({a, b, c});
  evidence.truncate(1);
  evidence.add({d});
  expect({a, d});
  evidence.add({b});
  evidence.keep({2, 0});
  expect({b, a});
}
