// Decimation keeps what the eye reads: extremes, order, ends.
#include "host/report/decimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace stiction::host {
namespace {

struct Lap {
  std::vector<double> angle;
  std::vector<std::vector<double>> channels;
  std::vector<std::span<const double>> spans() const { return {channels.begin(), channels.end()}; }
};

// Noise with one single-sample peak a channel at a random instant.
Lap noisy_lap(std::size_t samples, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  std::uniform_int_distribution<std::size_t> instant(0, samples - 1);
  Lap lap;
  for (std::size_t i = 0; i < samples; ++i)
    lap.angle.push_back(0.25 * std::numbers::pi +
                        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(samples));
  for (int channel = 0; channel < 5; ++channel) {
    lap.channels.emplace_back(samples);
    for (auto& value : lap.channels.back()) value = 5.0 + noise(random);
    lap.channels.back()[instant(random)] = 20.0;
    lap.channels.back()[instant(random)] = -3.0;
  }
  return lap;
}

TEST(SelectInstants, KeepsBothExtremesOfEveryChannelWithinTheLimit) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto lap = noisy_lap(20000, seed);
    const auto kept = select_instants(lap.angle, lap.spans(), 1500);
    EXPECT_LE(kept.size(), 1500u);
    EXPECT_GT(kept.size(), 1000u);
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), lap.angle.size() - 1);
    for (const auto& channel : lap.channels) {
      const auto [low, high] = std::minmax_element(channel.begin(), channel.end());
      const auto value = [&](std::size_t i) { return channel[i]; };
      EXPECT_EQ(std::ranges::max(kept, {}, value), high - channel.begin()) << "seed " << seed;
      EXPECT_EQ(std::ranges::min(kept, {}, value), low - channel.begin()) << "seed " << seed;
    }
  }
}

TEST(SelectInstants, SpendsTheLimitOnSmoothChannelsToo) {
  auto lap = noisy_lap(20000, 1);
  for (auto& channel : lap.channels)
    for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = std::sin(lap.angle[i]);
  const auto kept = select_instants(lap.angle, lap.spans(), 1500);
  EXPECT_LE(kept.size(), 1500u);
  EXPECT_GT(kept.size(), 1200u);
}

TEST(SelectInstants, TakesNarrowerBinsNearReversals) {
  const auto lap = noisy_lap(170000, 1);  // 3.2 m/min: channels seldom coincide even in the narrowest bins
  std::size_t near = 0, all = 0;
  for (const auto i : select_instants(lap.angle, lap.spans(), 1500)) {
    near += std::abs(std::remainder(lap.angle[i], 0.5 * std::numbers::pi)) < 10.0 * std::numbers::pi / 180.0;
    ++all;
  }
  // The integral of 1 + 20 / (1 + (angle / 2 degrees)^2) over 10 degrees is 61 % of that over 45.
  EXPECT_NEAR(static_cast<double>(near) / static_cast<double>(all), 0.61, 0.03);
}

TEST(SelectInstants, TakesTheSameInstantsWhetherAnglesAreWrappedOrNotAndWhicheverWayTheyTurn) {
  auto lap = noisy_lap(20000, 1);
  const auto kept = select_instants(lap.angle, lap.spans(), 1500);
  for (auto& angle : lap.angle) angle = std::remainder(angle, 2.0 * std::numbers::pi);
  EXPECT_EQ(select_instants(lap.angle, lap.spans(), 1500).size(), kept.size());
  for (auto& angle : lap.angle) angle = -angle;
  EXPECT_EQ(select_instants(lap.angle, lap.spans(), 1500).size(), kept.size());
}

TEST(SelectInstants, KeepsAShortLapWhole) {
  const auto lap = noisy_lap(700, 1);
  EXPECT_EQ(select_instants(lap.angle, lap.spans(), 1500).size(), 700u);
}

TEST(SelectInstants, RefusesUnequalLengthsAndATooSmallLimit) {
  auto lap = noisy_lap(700, 1);
  EXPECT_THROW(select_instants(lap.angle, lap.spans(), 16), std::invalid_argument);
  lap.channels[2].pop_back();
  EXPECT_THROW(select_instants(lap.angle, lap.spans(), 1500), std::invalid_argument);
}

// Noise with a peak up and a peak down in one bin, and one more of each elsewhere.
struct Line {
  std::vector<double> x, y;
};

Line noisy_line(std::size_t samples, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  std::uniform_int_distribution<std::size_t> instant(0, samples - 2);
  Line line;
  for (std::size_t i = 0; i < samples; ++i) {
    line.x.push_back(static_cast<double>(i));
    line.y.push_back(noise(random));
  }
  const auto peak = instant(random);
  line.y[peak] = 20.0;
  line.y[peak + 1] = -30.0;
  return line;
}

TEST(SelectExtremes, KeepsEndsAndNeighbouringPeaksWithinTheLimit) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto line = noisy_line(80000, seed);
    const auto kept = select_extremes(line.x, line.y, 3000);
    EXPECT_LE(kept.size(), 3000u);
    EXPECT_GT(kept.size(), 2900u);
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), line.x.size() - 1);
    const auto value = [&](std::size_t i) { return line.y[i]; };
    EXPECT_EQ(std::ranges::max(kept, {}, value), std::ranges::max_element(line.y) - line.y.begin()) << "seed " << seed;
    EXPECT_EQ(std::ranges::min(kept, {}, value), std::ranges::min_element(line.y) - line.y.begin()) << "seed " << seed;
  }
}

TEST(SelectExtremes, KeepsTheReachOfALoopInBothDirections) {
  Line loop;
  for (int i = 0; i < 50000; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / 50000.0;
    loop.x.push_back(std::sin(phase));
    loop.y.push_back(std::cos(3.0 * phase));
  }
  loop.x[20001] = 5.0;  // where y is neither largest nor smallest of its bin
  const auto kept = select_extremes(loop.x, loop.y, 3000);
  EXPECT_LE(kept.size(), 3000u);
  EXPECT_TRUE(std::ranges::binary_search(kept, 20001u));
}

TEST(SelectExtremes, KeepsAGap) {
  auto line = noisy_line(80000, 1);
  for (std::size_t i = 40000; i < 40400; ++i) line.y[i] = std::nan("");
  const auto kept = select_extremes(line.x, line.y, 3000);
  EXPECT_LE(kept.size(), 3000u);
  EXPECT_TRUE(std::ranges::any_of(kept, [&](std::size_t i) { return std::isnan(line.y[i]); }));
}

TEST(SelectExtremes, KeepsAShortLineWholeAndRefusesUnequalLengths) {
  auto line = noisy_line(3000, 1);
  EXPECT_EQ(select_extremes(line.x, line.y, 3000).size(), 3000u);
  EXPECT_THROW(select_extremes(line.x, line.y, 6), std::invalid_argument);
  line.y.pop_back();
  EXPECT_THROW(select_extremes(line.x, line.y, 3000), std::invalid_argument);
}

}  // namespace
}  // namespace stiction::host
