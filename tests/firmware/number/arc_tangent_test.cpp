// The integer angle of a vector against the C library's arc tangent.
#include "stiction/number/arc_tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace stiction {
namespace {

double turns_off(std::int64_t x, std::int64_t y) {
  const double truth = std::atan2(static_cast<double>(y), static_cast<double>(x)) / (2.0 * std::numbers::pi);
  return std::remainder(angle_of(x, y).raw * 0x1p-32 - truth, 1.0);
}

TEST(ArcTangent, IsThatOfTheLibraryForVectorsOfEveryDirectionAndLength) {
  std::mt19937_64 random(28);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (int k = 0; k < 100000; ++k) {
    const double angle = 2.0 * std::numbers::pi * unit(random), length = std::exp2(21.0 + 39.0 * unit(random));
    const auto x = static_cast<std::int64_t>(length * std::cos(angle));
    const auto y = static_cast<std::int64_t>(length * std::sin(angle));
    worst = std::max(worst, std::abs(turns_off(x, y)));
  }
  // The last of 24 halved angles, and what the shifts cut off of the shortest vectors: 24 in 2^21.
  EXPECT_LE(worst, 0x1p-18);
}

TEST(ArcTangent, IsExactEnoughOnTheAxes) {
  constexpr std::int64_t one = std::int64_t{1} << 40;
  EXPECT_LE(std::abs(turns_off(one, 0)), 0x1p-24);
  EXPECT_LE(std::abs(turns_off(-one, 0)), 0x1p-24);
  EXPECT_LE(std::abs(turns_off(0, one)), 0x1p-24);
  EXPECT_LE(std::abs(turns_off(0, -one)), 0x1p-24);
  EXPECT_EQ(angle_of(0, 0).raw, 0u);
}

}  // namespace
}  // namespace stiction
