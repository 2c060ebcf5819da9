#include "host/log/resolution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace stiction::host {
namespace {

std::vector<double> sine(std::size_t samples, double amplitude, double per_sample) {
  std::vector<double> values;
  for (std::size_t k = 0; k < samples; ++k) values.push_back(amplitude * std::sin(per_sample * static_cast<double>(k)));
  return values;
}

std::vector<double> rounded(std::vector<double> values, double increment) {
  for (double& value : values) value = increment * std::round(value / increment);
  return values;
}

TEST(Resolution, FindsTheCountsOfEncodersFromFineToCoarse) {
  for (const double increment : {1e-9, 2e-8, 5e-7, 1e-5, 1e-4})
    EXPECT_NEAR(increment_of(rounded(sine(5000, 0.09, 0.003), increment)), increment, 1e-6 * increment);
}

// 4096 counts a turn written with six decimals: the decimals are a grid too, and not the encoder's.
TEST(Resolution, FindsCountsThatWereRoundedAgainToTheDigitsOfTheText) {
  const double count = 2.0 * std::numbers::pi / 4096.0;
  EXPECT_NEAR(increment_of(rounded(rounded(sine(1100, 1.0, 0.02), count), 1e-6)), count, 1e-4 * count);
}

TEST(Resolution, IsNotLedAstrayByAFewValuesOffTheGrid) {
  auto values = rounded(sine(5000, 0.09, 0.003), 1e-6);
  for (std::size_t k = 50; k < values.size(); k += 100) values[k] += 3.7e-7;
  EXPECT_NEAR(increment_of(values), 1e-6, 1e-10);
}

TEST(Resolution, FindsNoneInFullPrecisionInAConstantAndInNothing) {
  EXPECT_EQ(increment_of(sine(5000, 0.09, 0.003)), 0.0);
  EXPECT_EQ(increment_of(std::vector<double>(100, 0.25)), 0.0);
  EXPECT_EQ(increment_of({}), 0.0);
}

// A noise of 1 um on a smooth motion, and on one that rests for two thirds of the time.
TEST(Resolution, MeasuresTheNoiseOfAMovingChannel) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1e-6);
  auto values = sine(20000, 0.09, 0.003);
  for (double& value : values) value += noise(random);
  EXPECT_NEAR(noise_of(values), 1e-6, 0.05e-6);
}

// The rounding of a moving encoder is a noise of the increment over the root of 12, though the encoder rests longer.
TEST(Resolution, MeasuresTheRoundingOfAnEncoderThatRestsMostOfTheTime) {
  auto values = rounded(sine(5000, 0.09, 0.01), 1e-5);
  values.insert(values.end(), 10000, values.back());
  EXPECT_NEAR(noise_of(values), 1e-5 / std::sqrt(12.0), 0.15 * 1e-5 / std::sqrt(12.0));
}

TEST(Resolution, SeesNoNoiseWhereThereIsNone) {
  EXPECT_LT(noise_of(sine(5000, 0.09, 0.01)), 1e-12);
  EXPECT_EQ(noise_of(std::vector<double>(100, 0.25)), 0.0);
}

}  // namespace
}  // namespace stiction::host
