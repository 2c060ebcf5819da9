// Integer sine against long double over a dense sweep, its symmetries to the bit, and its exact values.
#include "stiction/number/trigonometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

constexpr std::uint32_t quarter = 1u << 30;
constexpr std::int32_t one = 1 << 30;  // of Sine

std::int32_t sine_raw(std::uint32_t turn) { return sine(Turn{turn}).raw(); }

TEST(Sine, IsWithinItsStatedErrorOverTheWholeTurn) {
  // The header states 6e-9. The minimax polynomial takes 3.4e-9; the last step rounds by half a bit (0.47e-9), the four
  // before by half a bit each, weighted by powers of a quarter turn below one. A stride prime to 2^32 meets every kind
  // of low bits: 5.2 million angles.
  constexpr std::uint32_t stride = 821;
  constexpr std::uint64_t turn = std::uint64_t{1} << 32;
  long double worst = 0.0L;
  for (std::uint64_t raw = 0; raw < turn; raw += stride) {
    const long double angle = 2.0L * std::numbers::pi_v<long double> * static_cast<long double>(raw) / turn;
    const long double error = static_cast<long double>(sine_raw(static_cast<std::uint32_t>(raw))) / one - sinl(angle);
    worst = std::max(worst, fabsl(error));
  }
  RecordProperty("worst_error", std::to_string(static_cast<double>(worst)));
  EXPECT_LT(worst, 6e-9L);
  EXPECT_GT(worst, 3.4e-9L) << "better than the polynomial's own error: the statement in the header is stale";
}

TEST(Sine, IsExactAtTheQuarterTurns) {
  EXPECT_EQ(sine_raw(0), 0);
  EXPECT_EQ(sine_raw(quarter), one);
  EXPECT_EQ(sine_raw(2 * quarter), 0);
  EXPECT_EQ(sine_raw(3 * quarter), -one);
  EXPECT_EQ(cosine(Turn{0}).raw(), one);
  EXPECT_EQ(cosine(Turn{quarter}).raw(), 0);
  EXPECT_EQ(cosine(Turn{2 * quarter}).raw(), -one);
}

TEST(Sine, NeverExceedsOneBesideItsPeak) {
  // Flat within a bit over +-2^-15 turns: the place where an error of the polynomial would leave the range.
  for (std::uint32_t i = 0; i < 400000; ++i) {
    ASSERT_LE(sine_raw(quarter - i), one) << i;
    ASSERT_GE(sine_raw(3 * quarter + i), -one) << i;
  }
}

TEST(Sine, CrossesZeroWithItsOwnSlope) {
  // sin(2 pi r 2^-32) * 2^30 = pi/2 * r for small r; rounding of the slope's coefficient and of the product.
  for (std::int32_t r = -1000; r <= 1000; ++r)
    ASSERT_NEAR(sine_raw(static_cast<std::uint32_t>(r)), 0.5 * std::numbers::pi * r, 0.51) << r;
}

RC_GTEST_PROP(Sine, IsOddAndMirroredAtTheQuarterToTheBit, ()) {
  const auto raw = static_cast<std::uint32_t>(test::drawn_between(0, UINT32_MAX));
  RC_ASSERT(sine_raw(0u - raw) == -sine_raw(raw));
  RC_ASSERT(sine_raw(2 * quarter - raw) == sine_raw(raw));
  RC_ASSERT(sine_raw(raw + 2 * quarter) == -sine_raw(raw));
  RC_ASSERT(cosine(Turn{raw}).raw() == sine_raw(raw + quarter));
}

RC_GTEST_PROP(Sine, AndCosineLieOnTheUnitCircle, ()) {
  const auto raw = static_cast<std::uint32_t>(test::drawn_between(0, UINT32_MAX));
  const double s = static_cast<double>(sine_raw(raw)) / one;
  const double c = static_cast<double>(cosine(Turn{raw}).raw()) / one;
  // d(s^2 + c^2) = 2 (s ds + c dc) <= 2 sqrt(2) * 6e-9.
  RC_ASSERT(std::abs(s * s + c * c - 1.0) < 1.7e-8);
}

}  // namespace
}  // namespace stiction
