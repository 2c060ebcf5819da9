// The simulation's own arc functions and complex numbers against those of long double and of <complex>.
#include "sim/number/arc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/number/complex.hpp"

namespace stiction::sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// In units of the last place of `exact`.
double units_off(double found, long double exact) {
  const auto size = std::fabs(static_cast<double>(exact));
  return static_cast<double>(std::fabs(found - exact)) / (std::nextafter(size, infinity) - size);
}

TEST(ArcTangent, IsWithinTwoUnitsOfTheLastPlaceInEveryDirection) {
  double largest = 0.0;
  for (double x = 1e-12; x < 1e12; x *= 1.003)
    for (const double y : {1.0, 0.3141592653589793, 17.0})
      for (const auto& [a, b] : {std::pair{y, x}, {-y, x}, {y, -x}, {-y, -x}})
        largest = std::fmax(largest, units_off(arc_tangent(a, b), std::atan2(static_cast<long double>(a), b)));
  for (int k = 0; k <= 64; ++k) {
    const double q = k / 64.0;  // nodes of the table, and half of the way between them
    largest = std::fmax(largest, units_off(arc_tangent(q + 1e-9, 1.0), std::atan(q + 1e-9L)));
  }
  EXPECT_LE(largest, 2.0);
}

TEST(ArcTangent, HasTheSignsOfZeroAndNoneOfWhatIsNoNumber) {
  for (const double y : {0.0, -0.0, 1.0, -1.0})
    for (const double x : {0.0, -0.0, 1.0, -1.0}) {
      EXPECT_NEAR(arc_tangent(y, x), std::atan2(y, x), 1e-15) << y << ", " << x;
      EXPECT_EQ(std::signbit(arc_tangent(y, x)), std::signbit(y)) << y << ", " << x;
    }
  for (const double bad : {infinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(std::isnan(arc_tangent(bad, bad)));
}

TEST(ArcCosine, IsWithinFourUnitsOfTheLastPlaceAndArcSineWithinThree) {
  double cosine = 0.0, sine = 0.0;
  const auto check = [&](double x) {
    cosine = std::fmax(cosine, units_off(arc_cosine(x), std::acos(static_cast<long double>(x))));
    sine = std::fmax(sine, units_off(arc_sine(x), std::asin(static_cast<long double>(x))));
  };
  for (int k = -9999; k < 10000; ++k)
    if (k != 0) check(k * 1e-4);
  for (double near = 0.5; near > 1e-15; near *= 0.7) check(1.0 - near), check(near - 1.0);
  EXPECT_LE(cosine, 4.0);
  EXPECT_LE(sine, 3.0);
  EXPECT_EQ(arc_cosine(1.0), 0.0);
}

TEST(ComplexNumbers, AgreeWithThoseOfTheLibrary) {
  const std::complex<double> all[] = {{3.0, 4.0}, {-0.02, 117.0}, {-12.5, -0.1}, {1e-3, -2e-4}};
  for (const auto a : all)
    for (const auto b : all) {
      EXPECT_LE(magnitude(quotient(a, b) - a / b), 4e-16 * std::abs(a / b));
      EXPECT_NEAR(magnitude(a), std::abs(a), 2e-16 * std::abs(a));
      EXPECT_NEAR(angle_of(a), std::arg(a), 1e-15);
      EXPECT_LE(magnitude(exponential(a) - std::exp(a)), 2e-15 * std::abs(std::exp(a)));
      EXPECT_LE(magnitude(in_direction(magnitude(a), angle_of(a)) - a), 1e-15 * std::abs(a));
    }
}

}  // namespace
}  // namespace stiction::sim
