// Places at which a residual stands out, found in rows made by arithmetic.
#include "host/diagnose/spectrum/place_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "host/diagnose/record/record_rows.hpp"
#include "tests/host/diagnose/synthetic_log.hpp"

namespace stiction::test {
namespace {

// Trajectory 0 of the synthetic logs, from 0 to 0.25 m.
host::LogRows rows() {
  const std::vector<host::Log> logs{synthetic_log(0, {}, 1.0, 1)};
  return host::rows_of(logs, bench_machine().axes.front(), host::signals_in(host::RowBand::usual, logs));
}

Eigen::VectorXd along(const host::LogRows& rows, double (*force)(double x)) {
  return rows.stacked([&](const host::Motion& motion) {
    std::vector<double> values;
    for (const double x : motion.x) values.push_back(force(x));
    return values;
  });
}

Eigen::VectorXd white_noise(Eigen::Index count, double deviation) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, deviation);
  Eigen::VectorXd values(count);
  for (double& v : values) v = normal(random);
  return values;
}

}  // namespace

// 2 N on 8 mm at 61 mm, as a squared cosine, in noise of 1 N: one of the places that were found is within 1 mm of it.
TEST(PlaceScan, finds_the_place_of_a_push_in_noise) {
  const auto r = rows();
  const Eigen::VectorXd residual =
      white_noise(r.rows(), 1.0) + along(r, [](double x) {
        const double off = (x - 0.061) / 4e-3;
        return std::abs(off) < 1.0 ? 2.0 * std::pow(std::cos(0.5 * std::numbers::pi * off), 2) : 0.0;
      });
  host::PlaceScan scan;
  host::scan_places(r, residual, {}, Eigen::VectorXd::Ones(r.rows()), 0.0, 0.25, scan);
  EXPECT_EQ(scan.first_new, 0U);
  EXPECT_TRUE(std::any_of(scan.places.begin(), scan.places.end(), [](const host::Place& place) {
    return std::abs(place.at - 0.061) < 1e-3 && place.foot > 2e-3 && place.foot < 8e-3;
  }));
}

// What a later scan finds comes behind; a place found before keeps its value.
TEST(PlaceScan, adds_to_the_places_that_are_known) {
  const auto r = rows();
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(r.rows());
  host::PlaceScan scan;
  host::scan_places(r, along(r, [](double x) { return std::max(1.0 - std::abs(x - 0.05) / 5e-3, 0.0); }), {}, ones, 0.0,
                    0.25, scan);
  const auto known = scan.places;
  host::scan_places(r, along(r, [](double x) { return std::max(1.0 - std::abs(x - 0.2) / 5e-3, 0.0); }), {}, ones, 0.0,
                    0.25, scan);
  ASSERT_GT(scan.places.size(), known.size());
  EXPECT_EQ(scan.first_new, known.size());
  EXPECT_TRUE(std::equal(known.begin(), known.end(), scan.places.begin()));
  for (std::size_t k = 0; k < scan.places.size(); ++k) {
    const double value = host::PlaceScan::value_of(k);
    EXPECT_TRUE(host::PlaceScan::is_place(value));
    EXPECT_EQ(scan.at(value), scan.places[k]);
  }
}

TEST(PlaceScan, finds_nothing_without_a_stroke) {
  const auto r = rows();
  host::PlaceScan scan;
  host::scan_places(r, white_noise(r.rows(), 1.0), {}, Eigen::VectorXd::Ones(r.rows()), 0.1, 0.1, scan);
  EXPECT_TRUE(scan.places.empty());
}

}  // namespace stiction::test
