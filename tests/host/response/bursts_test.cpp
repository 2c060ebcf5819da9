#include "host/response/bursts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace stiction::test {
namespace {

using host::find_bursts;

std::vector<double> sine(std::size_t period, std::size_t count) {
  std::vector<double> signal(count);
  for (std::size_t k = 0; k < count; ++k)
    signal[k] = std::sin(2.0 * std::numbers::pi * (static_cast<double>(k) + 0.3) / static_cast<double>(period));
  return signal;
}

TEST(Bursts, ArePartedByPausesAndHaveTheirPeriods) {
  std::vector<double> signal(100, 0.0);
  for (const std::size_t period : {std::size_t{40}, std::size_t{250}}) {
    const auto part = sine(period, 6 * period);
    signal.insert(signal.end(), part.begin(), part.end());
    signal.insert(signal.end(), 100, 0.0);
  }
  const auto bursts = find_bursts(signal, 50);
  ASSERT_EQ(bursts.size(), 2u);
  EXPECT_EQ(bursts[0].begin, 100u);
  EXPECT_EQ(bursts[0].end, 340u);
  EXPECT_EQ(bursts[0].period, 40u);
  EXPECT_EQ(bursts[1].size(), 1500u);
  EXPECT_EQ(bursts[1].period, 250u);
}

TEST(Bursts, AZeroWithinTheSignalIsNoPause) {
  auto signal = sine(100, 500);
  signal[200] = signal[201] = 0.0;
  EXPECT_EQ(find_bursts(signal, 5).size(), 1u);
}

TEST(Bursts, ThePeriodOfASlowSignalSampledFastIsNotOneSample) {
  EXPECT_EQ(find_bursts(sine(8000, 24000), 80).front().period, 8000u);
}

TEST(Bursts, ASignalRoundedToADriveResolutionStillRepeats) {
  auto signal = sine(500, 2000);
  for (auto& value : signal) value = std::round(value * 200.0) / 200.0;
  EXPECT_EQ(find_bursts(signal, 5).front().period, 500u);
}

TEST(Bursts, NoiseHasNoPeriod) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> signal(5000);
  for (auto& value : signal) value = normal(random);
  EXPECT_EQ(find_bursts(signal, 5).front().period, 0u);
}

TEST(Bursts, NothingIsFoundWhereNothingIs) { EXPECT_TRUE(find_bursts(std::vector<double>(100, 0.0), 5).empty()); }

}  // namespace
}  // namespace stiction::test
