// Prices of names by what records of exact machines say for them, on log odds whose law is known.
#include "host/diagnose/search/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "host/diagnose/search/price.hpp"

namespace {

using namespace stiction::host;

// Records of three rows, each `gain` times the force they are drawn under; `followed` of them can be simulated.
SearchContext context_of(double gain, std::size_t followed = 1000) {
  SearchContext context;
  context.exact_records = [=](const Eigen::VectorXd& force) -> ExactRecords {
    return [=](std::size_t begin, std::size_t end) {
      std::vector<ExactRecord> records;
      for (std::size_t draw = begin; draw < std::min(end, followed); ++draw)
        records.push_back(ExactRecord{gain * force, {}});
      return records;
    };
  };
  return context;
}

const Eigen::Vector3d left_over(1.0, -2.0, 2.0);

}  // namespace

// Log odds of -4 and an exponential part of one nat, as of two records in which nothing is: a price would be a loss.
TEST(Calibration, asks_nothing_where_exact_records_have_little_odds) {
  std::mt19937_64 random(1);
  std::exponential_distribution<double> tail;
  Calibration calibration(context_of(1.0), left_over);
  EXPECT_EQ(calibration.records(), 24U);
  const auto prices = calibration.prices([&](const ExactRecord&) { return std::vector{-4.0 + tail(random)}; }, {30.0});
  EXPECT_EQ(prices[0].limit, 0.0);
  EXPECT_EQ(prices[0].typical, 0.0);
}

// What one record in a hundred exceeds, shared among all candidates: 50 + ln(100 n) for a tail of one nat; the median
// is 50 + ln 2.
TEST(Calibration, prices_a_name_by_the_tail_of_its_odds) {
  std::mt19937_64 random(2);
  std::exponential_distribution<double> tail;
  Calibration calibration(context_of(1.0), left_over);
  const double expected = 50.0 + std::log(100.0 * static_cast<double>(candidates().size())) - sure;
  double mean = 0.0, typical = 0.0;
  constexpr int times = 200;
  for (int k = 0; k < times; ++k) {
    const auto price =
        calibration.prices([&](const ExactRecord&) { return std::vector{50.0 + tail(random)}; }, {1000.0})[0];
    mean += price.limit / times;
    typical += price.typical / times;
  }
  EXPECT_NEAR(mean, expected, 0.05 * expected);
  EXPECT_NEAR(typical, 50.0 + std::log(2.0), 0.1);
}

// The price is about 58 nats, and known from 24 records to some 2.5.
TEST(Calibration, draws_more_records_where_a_name_is_near_its_price) {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> tail;
  const auto looked_at = [&](double own) {
    Calibration calibration(context_of(1.0), left_over);
    calibration.prices([&](const ExactRecord&) { return std::vector{50.0 + tail(random)}; }, {own});
    return calibration.records();
  };
  EXPECT_EQ(looked_at(1000.0), 24U);
  EXPECT_EQ(looked_at(3.0), 24U);
  EXPECT_GT(looked_at(59.0), 24U);
  EXPECT_LE(looked_at(59.0), 120U);
}

TEST(Calibration, knows_nothing_of_few_records) {
  EXPECT_EQ(Calibration(context_of(1.0, 7), left_over).records(), 0U);
  EXPECT_EQ(Calibration(context_of(1.0, 8), left_over).records(), 8U);
}

TEST(Calibration, does_not_price_what_no_exact_record_can_have) {
  Calibration calibration(context_of(1.0), left_over);
  const auto prices = calibration.prices(
      [](const ExactRecord&) {
        return std::vector{-std::numeric_limits<double>::infinity(), 30.0};
      },
      {50.0, 50.0});
  EXPECT_EQ(prices[0].limit, 0.0);
  EXPECT_EQ(prices[1].limit, 30.0 - sure);
}

// The loop's answer and the encoder's steps add to what is drawn.
TEST(Calibration, draws_forces_under_which_the_exact_machine_leaves_as_much) {
  for (const double gain : {0.5, 1.0, 4.0}) {
    Calibration calibration(context_of(gain), left_over);
    calibration.prices(
        [&](const ExactRecord& record) {
          EXPECT_NEAR(record.target.norm(), std::min(gain, 1.0) * left_over.norm(), 1e-12);
          return std::vector<double>{};
        },
        {});
  }
}
