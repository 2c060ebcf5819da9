// Points of the unit cube: against SciPy's Sobol sequence and tables of the normal distribution, and their properties.
#include "host/sweep/samples.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace stiction::host {
namespace {

TEST(SweepSamples, SobolPointsAreThoseOfSciPy) {
  constexpr std::array<std::uint32_t, 6> dimensions{0, 1, 2, 6, 13, 19};
  struct Known {
    std::uint64_t point;
    std::array<std::uint32_t, 6> places;
  };
  // scipy.stats.qmc.Sobol(20, scramble=False, bits=32) of SciPy 1.10, times 2^32.
  constexpr std::array known{Known{1, {2147483648, 2147483648, 2147483648, 2147483648, 2147483648, 2147483648}},
                             Known{2, {3221225472, 1073741824, 1073741824, 1073741824, 1073741824, 1073741824}},
                             Known{3, {1073741824, 3221225472, 3221225472, 3221225472, 3221225472, 3221225472}},
                             Known{7, {536870912, 2684354560, 1610612736, 2684354560, 1610612736, 3758096384}},
                             Known{37, {3959422976, 2751463424, 2483027968, 738197504, 3690987520, 603979776}},
                             Known{63, {67108864, 3422552064, 1543503872, 2483027968, 3288334336, 1006632960}}};
  for (const auto& each : known)
    for (std::size_t k = 0; k < dimensions.size(); ++k)
      EXPECT_EQ(sobol_places(each.point, dimensions[k]), each.places[k])
          << "point " << each.point << ", dimension " << dimensions[k];
}

TEST(SweepSamples, TheFirstPointsOfSobolFillEachPartOnceWhateverTheSeed) {
  for (const std::uint64_t seed : {0, 1, 77})
    for (std::uint32_t dimension = 0; dimension < sobol_dimensions; ++dimension) {
      std::set<int> parts;
      for (std::uint64_t k = 0; k < 64; ++k)
        parts.insert(static_cast<int>(sample(SampleMethod::sobol, k, 64, dimension, seed) * 64.0));
      EXPECT_EQ(parts.size(), 64U) << dimension;
    }
}

TEST(SweepSamples, ALatinHypercubeHasOnePointInEachPartOfEachCoordinate) {
  for (const std::uint64_t count : {1, 2, 3, 10, 1000, 1025})
    for (std::uint32_t dimension = 0; dimension < 3; ++dimension) {
      std::set<std::uint64_t> parts;
      for (std::uint64_t k = 0; k < count; ++k) {
        const double u = sample(SampleMethod::latin_hypercube, k, count, dimension, 5);
        EXPECT_GT(u, 0.0);
        EXPECT_LT(u, 1.0);
        parts.insert(static_cast<std::uint64_t>(u * static_cast<double>(count)));
      }
      EXPECT_EQ(parts.size(), count);
    }
}

TEST(SweepSamples, CoordinatesOfALatinHypercubeDoNotFollowEachOther) {
  constexpr std::uint64_t count = 4000;
  for (std::uint32_t one = 0; one < 4; ++one)
    for (std::uint32_t other = one + 1; other < 4; ++other) {
      double sum = 0.0;
      for (std::uint64_t k = 0; k < count; ++k)
        sum += (sample(SampleMethod::latin_hypercube, k, count, one, 3) - 0.5) *
               (sample(SampleMethod::latin_hypercube, k, count, other, 3) - 0.5);
      // The correlation of independent numbers has the standard deviation 1/sqrt(n), 0.016: five of them.
      EXPECT_LT(std::abs(sum / count * 12.0), 5.0 / std::sqrt(static_cast<double>(count))) << one << " " << other;
    }
}

TEST(SweepSamples, ADifferentSeedGivesDifferentPoints) {
  for (const auto method : {SampleMethod::latin_hypercube, SampleMethod::sobol}) {
    int same = 0;
    for (std::uint64_t k = 0; k < 100; ++k) same += sample(method, k, 100, 0, 1) == sample(method, k, 100, 0, 2);
    EXPECT_LT(same, 3);
  }
}

TEST(SweepSamples, TheNormalQuantileIsThatOfTables) {
  EXPECT_DOUBLE_EQ(normal_quantile(0.5), 0.0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-9);
  EXPECT_NEAR(normal_quantile(0.025), -1.959963984540054, 1e-9);
  EXPECT_NEAR(normal_quantile(0.8413447460685429), 1.0, 1e-9);
  EXPECT_NEAR(normal_quantile(0.99), 2.3263478740408408, 1e-9);
  EXPECT_NEAR(normal_quantile(1e-6), -4.753424308822899, 1e-9);
}

}  // namespace
}  // namespace stiction::host
