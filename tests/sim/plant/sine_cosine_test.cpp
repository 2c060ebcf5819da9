// The simulation's own sine and cosine against those of long double.
#include "sim/number/sine_cosine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stiction::sim {
namespace {

TEST(SineCosine, IsWithinItsStatedErrorUpToAMillionRadians) {
  double largest = 0.0;
  const auto check = [&](double angle) {
    const auto [sine, cosine] = sine_cosine(angle);
    const long double exact = angle;
    largest = std::fmax(largest, static_cast<double>(std::fabs(sine - std::sin(exact))));
    largest = std::fmax(largest, static_cast<double>(std::fabs(cosine - std::cos(exact))));
  };
  for (double angle = 1e-9; angle <= 1e6; angle *= 1.0001) check(angle), check(-angle);
  for (int quarter = -40; quarter <= 40; ++quarter)
    for (double offset : {-1e-6, 0.0, 1e-6, 0.7853981633974483}) check(quarter * 1.5707963267948966 + offset);
  EXPECT_LE(largest, 3e-16);
}

TEST(SineCosine, OfZeroIsExact) {
  EXPECT_EQ(sine_cosine(0.0).sine, 0.0);
  EXPECT_EQ(sine_cosine(0.0).cosine, 1.0);
}

TEST(SineCosine, OfWhatIsNotANumberIsNone) {
  for (const double angle : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(std::isnan(sine_cosine(angle).sine));
    EXPECT_TRUE(std::isnan(sine_cosine(angle).cosine));
  }
}

}  // namespace
}  // namespace stiction::sim
