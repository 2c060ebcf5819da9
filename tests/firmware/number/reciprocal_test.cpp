// The rate of a sampling interval against the exact quotient.
#include "stiction/number/reciprocal.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using test::Int128;

constexpr Int128 scale = Int128{1000000000} << Rate::fraction_bits;  // 1 s in ns, in units of the rate's last bit

// True when |raw - scale / interval| <= scale / interval * 2^-bits + 1/2, without a rounding of the test's own.
bool within(std::int64_t raw, std::int64_t interval, int bits) {
  const Int128 error = Int128{raw} * interval - scale;  // in units of 1 / interval
  const Int128 size = error < 0 ? -error : error;
  return (2 * size - interval) * test::power_of_two(bits) <= 2 * scale;
}

TEST(RateOfInterval, IsWithinTwoToTheMinus29AndARoundingForEveryIntervalToAMillisecond) {
  // A 16-bit seed has a relative error below 2^-15, Newton's step squares it (2^-30) and its own truncation adds 2^-30.
  // The header promises 2^-28.
  for (std::int64_t interval = 1000; interval <= 1000000; ++interval)
    ASSERT_TRUE(within(rate_of_interval(interval).raw(), interval, 29)) << interval << " ns";
}

RC_GTEST_PROP(RateOfInterval, IsWithinTwoToTheMinus29AndARoundingToTheLongestInterval, ()) {
  const auto interval = test::drawn_between(1000, INT32_MAX);
  RC_ASSERT(within(rate_of_interval(interval).raw(), interval, 29));
}

TEST(RateOfInterval, HoldsBesideEveryPowerOfTwo) {
  for (int k = 10; k < 31; ++k)
    for (std::int64_t d = -3; d <= 3; ++d) {
      const std::int64_t interval = std::max<std::int64_t>(1000, (std::int64_t{1} << k) + d);
      ASSERT_TRUE(within(rate_of_interval(interval).raw(), interval, 29)) << interval << " ns";
    }
}

TEST(RateOfInterval, OfTheTickPeriodsInUseIsExactToTheFormat) {
  EXPECT_EQ(rate_of_interval(62500).raw(), 16000 << 10);
  EXPECT_EQ(rate_of_interval(125000).raw(), 8000 << 10);
  EXPECT_EQ(rate_of_interval(1000000).raw(), 1000 << 10);
  EXPECT_EQ(rate_of_interval(50000).raw(), 20000 << 10);
}

TEST(RateOfInterval, ClampsShortAndNegativeIntervalsToAMicrosecondAndLongOnesToTwoSeconds) {
  for (const std::int64_t interval :
       {std::int64_t{999}, std::int64_t{1}, std::int64_t{0}, std::int64_t{-62500}, INT64_MIN})
    EXPECT_EQ(rate_of_interval(interval).raw(), rate_of_interval(1000).raw()) << interval;
  for (const std::int64_t interval : {std::int64_t{INT32_MAX} + 1, std::int64_t{1} << 40, INT64_MAX})
    EXPECT_EQ(rate_of_interval(interval).raw(), rate_of_interval(INT32_MAX).raw()) << interval;
  // 1e6 1/s needs 29.93 bits: within the coefficient's 30.
  EXPECT_NEAR(rate_of_interval(1000).raw(), 1024000000, 2);
}

TEST(RateOfInterval, FallsWithTheIntervalWithinItsError) {
  std::int32_t before = rate_of_interval(1000).raw();
  for (std::int64_t interval = 1001; interval < 100000; ++interval) {
    const std::int32_t rate = rate_of_interval(interval).raw();
    ASSERT_LE(rate, before) << interval;  // neighbours differ by 1e-5 at least, far above the error of 2^-29
    before = rate;
  }
}

}  // namespace
}  // namespace stiction
