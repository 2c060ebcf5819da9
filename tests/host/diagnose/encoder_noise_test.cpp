// The noise of an encoder, from a motion by arithmetic: what is read is rounded to increments, with a Gaussian noise.
#include "host/diagnose/record/encoder_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/host/diagnose/synthetic_log.hpp"

namespace stiction::test {
namespace {

constexpr double increment = 1e-7;  // m

// Samples of 1 ms in a swing of 40 mm.
host::Log swing(double noise, double amplitude, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  host::Log log;
  log.axes.resize(1);
  log.period = 1e-3;
  for (int k = 0; k < 8000; ++k) {
    const double t = 1e-3 * k, x = amplitude * std::sin(2.0 * std::numbers::pi * 0.4 * t) + noise * normal(random);
    log.t.push_back(t);
    log.axes.front().x.push_back(std::round(x / increment) * increment);
  }
  return log;
}

machine::AxisModel axis_of_increments() {
  auto axis = bench_machine().axes.front();
  axis.encoder.increment = increment;
  return axis;
}

std::optional<double> noise_of(double noise, double amplitude = 0.04) {
  return host::encoder_noise({swing(noise, amplitude, 1), swing(noise, amplitude, 2)},
                             {swing(0.0, amplitude, 3), swing(0.0, amplitude, 4)}, axis_of_increments());
}

// Of 16 000 differences, each of which knows five samples.
TEST(EncoderNoise, IsToldBesideTheIncrement) {
  for (const double noise : {0.5 * increment, increment, 5.0 * increment}) {
    const auto found = noise_of(noise);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, noise, 0.03 * noise);
  }
}

TEST(EncoderNoise, IsNoneWhereStepsAreAllThereIs) {
  EXPECT_EQ(noise_of(0.0), 0.0);
  EXPECT_EQ(noise_of(0.05 * increment), 0.0);  // of the steps' 0.29
}

TEST(EncoderNoise, KnowsNothingOfSpikesAndLostSamples) {
  auto log = swing(increment, 0.04, 1);
  auto& x = log.axes.front().x;
  for (std::size_t k = 100; k < x.size(); k += 500) x[k] += 1e-3;
  for (std::size_t k = 350; k < x.size(); k += 1000) x[k] = x[k - 1];
  const auto found = host::encoder_noise({log}, {swing(0.0, 0.04, 3)}, axis_of_increments());
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, increment, 0.05 * increment);
}

TEST(EncoderNoise, IsNotToldOfSlowRecords) {
  auto log = swing(increment, 0.04, 1);
  log.period = 4e-3;
  EXPECT_FALSE(host::encoder_noise({log}, {swing(0.0, 0.04, 3)}, axis_of_increments()));
}

TEST(EncoderNoise, IsNotToldOfAnAxisAtRest) { EXPECT_FALSE(noise_of(2.0 * increment, 0.0)); }

TEST(EncoderNoise, IsNotToldWithoutRuns) {
  EXPECT_FALSE(host::encoder_noise({swing(increment, 0.04, 1)}, {}, axis_of_increments()));
}

}  // namespace
}  // namespace stiction::test
