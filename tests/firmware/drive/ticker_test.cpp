// The two rates of the loop.
#include "stiction/drive/ticker.hpp"

#include <gtest/gtest.h>

namespace stiction {
namespace {

TEST(Ticker, TheFirstTickIsSlowAndAtTimeZero) {
  const Ticker ticker(62500, 16);
  EXPECT_TRUE(ticker.slow());
  EXPECT_EQ(ticker.now_ns(), 0);
  EXPECT_EQ(ticker.period_ns(), 62500);
}

TEST(Ticker, EverySixteenthTickIsSlowAndTimeIsTheTicksTimesThePeriod) {
  Ticker ticker(62500, 16);
  int slow = 0;
  for (std::int64_t i = 0; i < 16 * 1000; ++i) {
    ASSERT_EQ(ticker.slow(), i % 16 == 0) << i;
    ASSERT_EQ(ticker.now_ns(), i * 62500) << i;
    slow += ticker.slow();
    ticker.advance();
  }
  EXPECT_EQ(slow, 1000);
  EXPECT_EQ(ticker.now_ns(), std::int64_t{1000000000}) << "no drift: a second after a second";
}

TEST(Ticker, WithARatioOfOneEveryTickIsSlow) {
  Ticker ticker(1000000, 1);
  for (int i = 0; i < 10; ++i, ticker.advance()) EXPECT_TRUE(ticker.slow());
}

TEST(Ticker, CountsOnPastThirtyTwoBitsOfNanoseconds) {
  Ticker ticker(1000000000, 3);
  for (int i = 0; i < 10; ++i) ticker.advance();
  EXPECT_EQ(ticker.now_ns(), 10'000'000'000);
}

}  // namespace
}  // namespace stiction
