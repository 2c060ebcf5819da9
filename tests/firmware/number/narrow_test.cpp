// narrow(): the one rule of rounding and the one of overflow, on types so small that every case is visible.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "stiction/number/fixed.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using Halves = Wide<1, 9>;  // -4.5 .. 4.5
using Whole = Wide<0, 3>;   // -3 .. 3

struct Case {
  std::int64_t halves;
  std::int64_t whole;
  std::uint32_t saturations;
};

constexpr std::array<Case, 19> every_half{{
    {-9, -3, 1}, {-8, -3, 1}, {-7, -3, 1},                          // -4.5, -4, -3.5: beyond the range after rounding
    {-6, -3, 0}, {-5, -3, 0}, {-4, -2, 0}, {-3, -2, 0},             // -2.5 -> -3, -1.5 -> -2
    {-2, -1, 0}, {-1, -1, 0}, {0, 0, 0},   {1, 1, 0},   {2, 1, 0},  // -0.5 -> -1, 0.5 -> 1
    {3, 2, 0},   {4, 2, 0},   {5, 3, 0},   {6, 3, 0},   {7, 3, 1},  // 3.5 -> 4, saturated to 3
    {8, 3, 1},   {9, 3, 1},
}};

TEST(Narrow, RoundsEveryHalfAwayFromZeroAndSaturatesAtBothEnds) {
  for (const auto& [halves, whole, saturations] : every_half) {
    SaturationCounter counter;
    EXPECT_EQ(narrow<Whole>(Halves::from_raw(halves), counter).raw(), whole) << halves << " halves";
    EXPECT_EQ(counter.count, saturations) << halves << " halves";
  }
}

TEST(Narrow, HoldsAtCompileTime) {
  constexpr auto rounded = [](std::int64_t halves) {
    SaturationCounter counter;
    return narrow<Whole>(Halves::from_raw(halves), counter).raw();
  };
  static_assert(rounded(-1) == -1 && rounded(1) == 1 && rounded(3) == 2 && rounded(9) == 3);
}

template <int Shift>
void check_every_value() {
  using In = Wide<Shift + 2, 700>;
  using Out = Wide<2, 5>;
  for (std::int64_t raw = In::lowest_raw; raw <= In::highest_raw; ++raw) {
    SaturationCounter counter;
    ASSERT_EQ(narrow<Out>(In::from_raw(raw), counter).raw(), test::expected_raw<Out>(raw, Shift + 2))
        << "shift " << Shift << ", raw " << raw;
    ASSERT_EQ(counter.count, test::leaves_range<Out>(raw, Shift + 2) ? 1u : 0u) << "shift " << Shift << ", raw " << raw;
  }
}

TEST(Narrow, AgreesWithExactRoundingForEveryValueOfSmallTypes) {
  check_every_value<0>();
  check_every_value<1>();
  check_every_value<2>();
  check_every_value<3>();
  check_every_value<5>();
  check_every_value<8>();
  check_every_value<12>();  // every value is below a half of the output's last bit
}

TEST(Narrow, ToMoreFractionBitsIsExactUntilItSaturates) {
  using In = Wide<0, 10>;
  using Out = Wide<3, 40>;  // -5 .. 5 in eighths
  for (std::int64_t raw = -10; raw <= 10; ++raw) {
    SaturationCounter counter;
    EXPECT_EQ(narrow<Out>(In::from_raw(raw), counter).raw(), std::clamp<std::int64_t>(8 * raw, -40, 40));
    EXPECT_EQ(counter.count, raw < -5 || raw > 5 ? 1u : 0u);
  }
}

TEST(Narrow, UsesTheWholeAsymmetricRangeOfASignal) {
  using In = Wide<1, std::uint64_t{1} << 34>;
  constexpr std::int64_t limit = std::int64_t{1} << 31;
  const std::vector<Case> cases{
      {2 * limit - 3, limit - 1, 0},  // 2^31 - 1.5 -> 2^31 - 1
      {2 * limit - 2, limit - 1, 0},  // 2^31 - 1, the highest
      {2 * limit - 1, limit - 1, 1},  // 2^31 - 0.5 rounds to 2^31: one too many
      {-2 * limit, -limit, 0},        // -2^31, the lowest
      {-2 * limit + 1, -limit, 0},    // -2^31 + 0.5 rounds away from zero to the lowest
      {-2 * limit - 1, -limit, 1},    // -2^31 - 0.5 rounds away from zero to -2^31 - 1
      {In::highest_raw, limit - 1, 1}, {In::lowest_raw, -limit, 1},
  };
  for (const auto& [halves, whole, saturations] : cases) {
    SaturationCounter counter;
    EXPECT_EQ(narrow<Fixed<0>>(In::from_raw(halves), counter).raw(), whole) << halves;
    EXPECT_EQ(counter.count, saturations) << halves;
  }
}

TEST(Narrow, CountsOncePerSaturatedOutputNeverForAnOutputAtItsEnd) {
  SaturationCounter counter;
  for (int i = 0; i < 5; ++i) narrow<Whole>(Halves::from_raw(9), counter);
  for (int i = 0; i < 5; ++i) narrow<Whole>(Halves::from_raw(6), counter);
  for (int i = 0; i < 2; ++i) narrow<Whole>(Halves::from_raw(-9), counter);
  EXPECT_EQ(counter.count, 7u);
}

TEST(Narrow, CountsOnBeyondAWord) {
  SaturationCounter counter{UINT32_MAX};
  narrow<Whole>(Halves::from_raw(9), counter);
  EXPECT_EQ(counter.count, std::uint64_t{1} << 32);
}

TEST(Narrow, CountersAddUpAndNeverStartAgain) {
  SaturationCounter sum{3};
  sum.add(SaturationCounter{4});
  EXPECT_EQ(sum.count, 7u);
  sum = SaturationCounter{UINT32_MAX};
  sum.add(SaturationCounter{2});
  EXPECT_GE(sum.count, UINT32_MAX);
}

TEST(Narrow, AtTheLargestShiftRoundsEverythingBelowAHalfToZero) {
  using In = Wide<62, (std::uint64_t{1} << 62) - 1>;  // below +-1
  SaturationCounter counter;
  const auto rounded = [&](std::int64_t raw) { return narrow<Wide<0, 8>>(In::from_raw(raw), counter).raw(); };
  constexpr std::int64_t half = std::int64_t{1} << 61;
  EXPECT_EQ(rounded(half - 1), 0);
  EXPECT_EQ(rounded(half), 1);
  EXPECT_EQ(rounded(-half + 1), 0);
  EXPECT_EQ(rounded(-half), -1);
  EXPECT_EQ(rounded(In::highest_raw), 1);
  EXPECT_EQ(rounded(In::lowest_raw), -1);
  EXPECT_EQ(counter.count, 0u);
}

TEST(Wide, FromRawClampsToTheBoundOfItsType) {
  using W = Wide<4, 100>;
  EXPECT_EQ(W::from_raw(100).raw(), 100);
  EXPECT_EQ(W::from_raw(101).raw(), 100);
  EXPECT_EQ(W::from_raw(INT64_MAX).raw(), 100);
  EXPECT_EQ(W::from_raw(-101).raw(), -100);
  EXPECT_EQ(W::from_raw(INT64_MIN).raw(), -100);
  using Widest = Wide<0, static_cast<std::uint64_t>(INT64_MAX)>;
  EXPECT_EQ(Widest::from_raw(INT64_MIN).raw(), -INT64_MAX);  // so that its negation is a value of the type too
  EXPECT_EQ((-Widest::from_raw(INT64_MIN)).raw(), INT64_MAX);
}

TEST(Coefficient, FromRawClampsToItsBits) {
  using C = Coefficient<8, 10>;
  EXPECT_EQ(C::from_raw(1024).raw(), 1024);
  EXPECT_EQ(C::from_raw(1025).raw(), 1024);
  EXPECT_EQ(C::from_raw(INT32_MAX).raw(), 1024);
  EXPECT_EQ(C::from_raw(-1025).raw(), -1024);
  EXPECT_EQ(C::from_raw(INT32_MIN).raw(), -1024);
  EXPECT_EQ(Coefficient<0>::from_raw(INT32_MAX).raw(), 1 << 30);
  SaturationCounter counter;
  EXPECT_EQ(narrow<C>(Fixed<8>::from_raw(5000), counter).raw(), 1024);
  EXPECT_EQ(narrow<C>(Fixed<8>::from_raw(-5000), counter).raw(), -1024);
  EXPECT_EQ(counter.count, 2u);
}

TEST(Exceeds, ComparesTheExactMagnitudeUpToTheLowestWord) {
  using T = Fixed<3>;
  const auto raw = [](std::int32_t x) { return T::from_raw(x); };
  EXPECT_TRUE(exceeds(raw(INT32_MIN), raw(INT32_MAX))) << "2^31 is one more than the highest word";
  EXPECT_FALSE(exceeds(raw(INT32_MAX), raw(INT32_MAX)));
  EXPECT_FALSE(exceeds(raw(-INT32_MAX), raw(INT32_MAX)));
  EXPECT_TRUE(exceeds(raw(-8), raw(7)));
  EXPECT_FALSE(exceeds(raw(-7), raw(7)));
  EXPECT_FALSE(exceeds(raw(0), raw(0)));
  EXPECT_TRUE(exceeds(raw(1), raw(0)));
}

TEST(Opposite, OfTheLowestWordIsTheHighest) {
  EXPECT_EQ(opposite(Fixed<3>::from_raw(INT32_MIN)).raw(), INT32_MAX);
  EXPECT_EQ(opposite(Fixed<3>::from_raw(INT32_MAX)).raw(), -INT32_MAX);
  EXPECT_EQ(opposite(Fixed<3>::from_raw(-5)).raw(), 5);
  EXPECT_EQ(opposite(Fixed<3>::from_raw(0)).raw(), 0);
}

TEST(Fixed, NumbersOfOneTypeCompareByValue) {
  EXPECT_LT(Fixed<4>::from_raw(-3), Fixed<4>::from_raw(2));
  EXPECT_EQ((Wide<4, 9>::from_raw(5)), (Wide<4, 9>::from_raw(5)));
  EXPECT_GT((Coefficient<4, 9>::from_raw(5)), (Coefficient<4, 9>::from_raw(-5)));
}

}  // namespace
}  // namespace stiction
