// Few elements in the place of many.
#include "host/tune/presliding_elements.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stiction::host {
namespace {

double curve(const std::vector<double>& distance, const std::vector<double>& level, double x) {
  double sum = 0.0;
  for (std::size_t k = 0; k < distance.size(); ++k) sum += level[k] * std::min(1.0, x / distance[k]);
  return sum;
}

TEST(PreslidingElements, keeps_what_is_few_already) {
  const auto e = draw_together({1e-6, 1e-5, 1e-4}, {0.1, 0.5, 0.2}, 8);
  EXPECT_NEAR(e.error, 0.0, 1e-12);
  double level = 0.0;
  for (const double l : e.level) level += l;
  EXPECT_NEAR(level, 0.8, 1e-12);
  for (const double x : {0.5e-6, 5e-6, 5e-5, 2e-4})
    EXPECT_NEAR(curve(e.distance, e.level, x), curve({1e-6, 1e-5, 1e-4}, {0.1, 0.5, 0.2}, x), 1e-12);
}

TEST(PreslidingElements, eight_stand_for_an_exponential_within_two_percent) {
  std::vector<double> distance, level;
  double before = 0.0;
  for (int k = 0; k < 27; ++k) {
    distance.push_back(1e-6 * std::pow(10.0, k / 8.0));
    const double share = 1.0 - std::exp(-distance.back() / 112e-6);
    level.push_back(share - before);
    before = share;
  }
  const auto e = draw_together(distance, level, 8);
  EXPECT_LE(e.distance.size(), 8u);
  EXPECT_TRUE(std::is_sorted(e.distance.begin(), e.distance.end()));
  EXPECT_LT(e.error, 0.02);
  EXPECT_NEAR(std::accumulate(e.level.begin(), e.level.end(), 0.0), before, 1e-12);
  for (double x = 1e-6; x < 2e-3; x *= 1.1)
    EXPECT_NEAR(curve(e.distance, e.level, x), curve(distance, level, x), e.error + 1e-9) << x;
}

}  // namespace
}  // namespace stiction::host
