// Trends and alarms of drawn estimates: intervals that hold, alarms at the stated rate, changes that are found.
#include "host/fleet/trends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace stiction::host {
namespace {

struct Drawn {
  double scatter = 0.01, error = 0.003;  // relative
  double drift = 0.0;                    // a month, of the Coulomb friction of the first axis, from `begin` on
  std::size_t begin = 0;
  double uneven = 0.0;  // how much the scatter differs between axes, as the deviation of its logarithm
};

std::vector<AxisHistory> drawn_fleet(std::size_t axes, std::size_t months, unsigned seed, const Drawn& drawn) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<AxisHistory> fleet;
  for (std::size_t a = 0; a < axes; ++a) {
    AxisHistory history{"axis " + std::to_string(a), {}, {}};
    const double scatter = drawn.scatter * std::exp(drawn.uneven * normal(engine));
    for (std::size_t m = 0; m < months; ++m) {
      history.days.push_back(20000.0 + days_of_month * static_cast<double>(m));
      RecordEstimate record;
      for (std::size_t c = 0; c < fleet_causes; ++c) {
        const bool force = static_cast<FleetCause>(c) == FleetCause::constant_force;
        const double level = 100.0;
        double value = force ? 0.0 : level;
        if (a == 0 && static_cast<FleetCause>(c) == FleetCause::coulomb && m >= drawn.begin)
          value += level * drawn.drift * static_cast<double>(m - drawn.begin + 1);
        record.causes[c] = {value + level * std::hypot(scatter, drawn.error) * normal(engine), level * drawn.error};
      }
      history.records.push_back(record);
    }
    fleet.push_back(std::move(history));
  }
  return fleet;
}

std::size_t alarms_of(const FleetTrends& fleet) {
  std::size_t alarms = 0;
  for (const auto& axis : fleet.axes)
    for (const auto& cause : axis.causes) alarms += cause.alarm.has_value();
  return alarms;
}

// Tables of one-sided sums: 1/ARL of Hawkins, Olwell 1998 for two-sided ones of reference 0.5: 465 at 5, 168 at 4.
TEST(FleetAlarms, HaveThePublishedRunLengths) {
  EXPECT_NEAR(1.0 / (2.0 * cusum_false_alarms(0.5, 5.0)), 465.0, 0.03 * 465.0);
  EXPECT_NEAR(1.0 / (2.0 * cusum_false_alarms(0.5, 4.0)), 168.0, 0.05 * 168.0);
  const double threshold = cusum_threshold(1.0, 1e-4);
  EXPECT_NEAR(cusum_false_alarms(1.0, threshold), 1e-4, 1e-7);
}

// Abramowitz, Stegun, tables 6.1 to 6.2.
TEST(FleetScatter, KnowsThePolygammaFunctions) {
  EXPECT_NEAR(digamma(1.0), -0.5772156649015329, 1e-9);
  EXPECT_NEAR(trigamma(1.0), 1.6449340668482264, 1e-9);
  EXPECT_NEAR(inverse_trigamma(trigamma(3.7)), 3.7, 1e-6);
}

// The expected number is 10; a rate of half a one in a fleet of a few hundred axis-years would be no test. More than 22
// have a probability of 2e-4.
TEST(FleetAlarms, AreAsRareAsStated) {
  constexpr double stated = 0.05;
  std::size_t alarms = 0, before = 0;
  for (unsigned fleet = 0; fleet < 4; ++fleet)
    alarms += alarms_of(trends_of(drawn_fleet(25, 24, 100 + fleet, {.uneven = 0.3}), stated));
  EXPECT_LE(alarms, 22U);
  // A rate ten times as large must show: the test above can fail.
  for (unsigned fleet = 0; fleet < 4; ++fleet)
    before += alarms_of(trends_of(drawn_fleet(25, 24, 100 + fleet, {.uneven = 0.3}), 10.0 * stated));
  EXPECT_GT(before, 22U);
}

TEST(FleetAlarms, FindAGrowingFrictionWithinMonthsAndNameIt) {
  const auto fleet = trends_of(drawn_fleet(50, 24, 7, {.drift = 0.02, .begin = 12}), 0.005);
  const auto& worst = fleet.axes.front();
  EXPECT_EQ(worst.history, 0U);
  const auto& coulomb = worst.causes[static_cast<std::size_t>(FleetCause::coulomb)];
  ASSERT_TRUE(coulomb.alarm);
  EXPECT_EQ(coulomb.alarm->direction, 1);
  EXPECT_GE(coulomb.alarm->record, 12U);
  EXPECT_LE(coulomb.alarm->record, 14U);  // the third record of the drift
  EXPECT_NEAR(static_cast<double>(coulomb.alarm->since), 12.0, 1.0);
  EXPECT_FALSE(worst.causes[static_cast<std::size_t>(FleetCause::mass)].alarm);
}

TEST(FleetTrends, IntervalsHoldTheTruth) {
  std::size_t held = 0, all = 0;
  for (unsigned seed = 0; seed < 6; ++seed)
    for (const auto& axis : trends_of(drawn_fleet(20, 12, 300 + seed, {.uneven = 0.3}), 0.005).axes)
      for (const auto& cause : axis.causes) {
        ++all;
        held += std::abs(cause.slope) <= cause.slope_half;
      }
  // 95 % of 480, three standard errors.
  EXPECT_NEAR(static_cast<double>(held) / static_cast<double>(all), 0.95, 0.03);
}

TEST(FleetTrends, BorrowTheScatterOfTheFleetWhereAnAxisHasFewRecords) {
  auto fleet = drawn_fleet(20, 12, 11, {});
  fleet[3].days.resize(3);
  fleet[3].records.resize(3);
  const auto trends = trends_of(fleet, 0.005);
  for (const auto& axis : trends.axes) {
    if (axis.history != 3) continue;
    for (const auto& cause : axis.causes) {
      EXPECT_GT(cause.freedom, 20.0);
      EXPECT_NEAR(cause.scatter, 0.0104, 0.004);
    }
  }
  EXPECT_NEAR(trends.between[0], 0.01, 0.002);
}

TEST(FleetTrends, SayNothingWhereNothingIsKnown) {
  const auto one = trends_of(drawn_fleet(1, 2, 1, {}), 0.005);
  EXPECT_FALSE(one.axes[0].causes[0].known());
  EXPECT_EQ(one.axes[0].causes[0].slope_half, 0.0);
  auto broken = drawn_fleet(4, 6, 1, {});
  for (auto& record : broken[0].records) record = {{}, "cannot be read"};
  const auto trends = trends_of(broken, 0.005);
  EXPECT_EQ(trends.axes.back().history, 0U);
  EXPECT_TRUE(trends.axes.back().causes[0].records.empty());
}

}  // namespace
}  // namespace stiction::host
