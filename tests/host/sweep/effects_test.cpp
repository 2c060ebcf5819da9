// Main effects, interactions and the Pareto front against functions whose answers are known.
#include "host/sweep/effects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "host/sweep/samples.hpp"

namespace stiction::host {
namespace {

double share_of(const FigureEffects& effects, const std::string& key) {
  for (const auto& each : effects.main)
    if (each.key == key) return each.share;
  return std::numeric_limits<double>::quiet_NaN();
}
double share_of(const FigureEffects& effects, const std::string& one, const std::string& other) {
  for (const auto& each : effects.interactions)
    if (each.first == one && each.second == other) return each.share;
  return std::numeric_limits<double>::quiet_NaN();
}

// Ishigami, Homma 1990: sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 over (-pi, pi)^3, whose shares are known in closed
// form: 0.3139, 0.4424 and 0 alone, 0.2437 of x1 with x3.
TEST(SweepEffects, FindTheSharesOfIshigamisFunction) {
  constexpr std::size_t count = 20000;
  std::vector<VariedKey> keys;
  for (std::uint32_t d = 0; d < 3; ++d) {
    VariedKey key{"x" + std::to_string(d + 1), true, {}, {}, {}, {}};
    for (std::size_t k = 0; k < count; ++k)
      key.numbers.push_back((2.0 * sample(SampleMethod::latin_hypercube, k, count, d, 1) - 1.0) * std::numbers::pi);
    keys.push_back(std::move(key));
  }
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    const double a = keys[0].numbers[k], b = keys[1].numbers[k], c = keys[2].numbers[k];
    values.push_back(std::sin(a) + 7.0 * std::sin(b) * std::sin(b) + 0.1 * std::pow(c, 4) * std::sin(a));
  }
  const auto effects = effects_on({"y", "", 0.0}, values, keys);
  // Twenty groups smooth sin^2 x2 by (sin w / w)^2, w = 2 pi / 20: 3 % of its share.
  EXPECT_NEAR(share_of(effects, "x1"), 0.3139, 0.01);
  EXPECT_NEAR(share_of(effects, "x2"), 0.4424 * 0.967, 0.01);
  EXPECT_NEAR(share_of(effects, "x3"), 0.0, 0.01);
  // Of pairs in five groups each, which see most of it.
  EXPECT_GT(share_of(effects, "x1", "x3"), 0.12);
  EXPECT_LT(share_of(effects, "x1", "x3"), 0.26);
  EXPECT_LT(share_of(effects, "x1", "x2"), 0.02);
  EXPECT_EQ(effects.main.front().key, "x2") << "the strongest first";
}

TEST(SweepEffects, OfAGridAreExact) {
  // y = a + 2 b + a b over a, b in {-1, 1}: variances 1, 4 and 1 of 6.
  VariedKey a{"a", false, {}, {0, 0, 1, 1}, {"-1", "1"}, {-1.0, 1.0}},
      b{"b", false, {}, {0, 1, 0, 1}, {"-1", "1"}, {-1.0, 1.0}};
  const auto effects =
      effects_on({"y", "", 0.0}, {-1.0 - 2.0 + 1.0, -1.0 + 2.0 - 1.0, 1.0 - 2.0 - 1.0, 1.0 + 2.0 + 1.0}, {a, b});
  EXPECT_NEAR(share_of(effects, "a"), 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(share_of(effects, "b"), 4.0 / 6.0, 1e-12);
  EXPECT_NEAR(share_of(effects, "a", "b"), 1.0 / 6.0, 1e-12);
}

TEST(SweepEffects, OfAFigureThatDoesNotVaryAreNone) {
  VariedKey a{"a", false, {}, {0, 1}, {"1", "2"}, {1.0, 2.0}};
  const auto effects = effects_on({"y", "", 0.0}, {0.1, 0.1 * (1.0 + 1e-16)}, {a});
  EXPECT_EQ(share_of(effects, "a"), 0.0);
}

TEST(SweepEffects, RowsWithoutTheFigureDoNotCount) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  VariedKey a{"a", false, {}, {0, 1, 1}, {"1", "2"}, {1.0, 2.0}};
  const auto effects = effects_on({"y", "", 0.0}, {3.0, none, 5.0}, {a});
  EXPECT_EQ(effects.rows, 2U);
  EXPECT_DOUBLE_EQ(effects.mean, 4.0);
  EXPECT_DOUBLE_EQ(effects.main.front().mean[1], 5.0);
  EXPECT_TRUE(std::isnan(effects_on({"y", "", 0.0}, {none}, {}).mean));
}

TEST(SweepEffects, TheParetoFrontIsWhatNoRowBeats) {
  std::vector<double> first, second;
  for (std::uint64_t k = 0; k < 200; ++k) {
    first.push_back(std::floor(sample(SampleMethod::latin_hypercube, k, 200, 0, 4) * 40.0));
    second.push_back(std::floor(sample(SampleMethod::latin_hypercube, k, 200, 1, 4) * 40.0));
  }
  first[3] = std::numeric_limits<double>::quiet_NaN();
  const auto front = pareto_front(first, second, 1);
  ASSERT_FALSE(front.empty());
  std::vector<bool> on_front(200);
  for (const auto& point : front) on_front[point.row] = true;
  for (std::size_t k = 0; k < 200; ++k) {
    bool beaten = std::isnan(first[k]);
    for (std::size_t j = 0; j < 200; ++j)
      // Of equal rows the first counts.
      beaten = beaten || (first[j] <= first[k] && second[j] <= second[k] &&
                          (first[j] < first[k] || second[j] < second[k] || j < k));
    EXPECT_EQ(on_front[k], !beaten) << k;
  }
}

}  // namespace
}  // namespace stiction::host
