// The arithmetic that friction laws are written in. The laws are templates over their scalar type: another type than
// double brings these functions as overloads of its own. For double they need no library of mathematics, so that a law
// gives the same bits wherever it is compiled.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace stiction::sim {

constexpr double absolute(double x) { return __builtin_fabs(x); }
constexpr double copy_sign(double magnitude, double sign) { return __builtin_copysign(magnitude, sign); }

// Of a number of at least 0; rounded correctly, by the processor's own instruction.
inline double square_root(double x) { return __builtin_sqrt(x); }

// e^x within 1 unit of the last place; 0 below -708, infinity above 709. The argument is reduced by a multiple of ln 2,
// in two parts so that the product is exact, and the rest is at most ln 2 / 2: the 14th term of the series is 5e-18.
constexpr double exponential(double x) {
  if (x < -708.0) return 0.0;
  if (x > 709.0) return std::numeric_limits<double>::infinity();
  constexpr double high = 0x1.62e42feep-1, low = 0x1.a39ef35793c76p-33;
  const double turns = x * 0x1.71547652b82fep+0;
  const auto k = static_cast<std::int64_t>(turns < 0.0 ? turns - 0.5 : turns + 0.5);
  const double r = (x - static_cast<double>(k) * high) - static_cast<double>(k) * low;
  double sum = 1.0;
  for (int n = 13; n > 0; --n) sum = 1.0 + r / n * sum;
  return sum * std::bit_cast<double>((k + 1023) << 52);
}

// The natural logarithm of a normal number above 0, within 2 units of the last place: 2 artanh((m - 1) / (m + 1)) for m
// in sqrt(1/2) to sqrt(2), beside the multiple of ln 2.
constexpr double logarithm(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffU) | 0x3ff0000000000000U);
  if (m > 0x1.6a09e667f3bcdp+0) m *= 0.5, ++exponent;
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double sum = 0.0;
  for (int n = 21; n > 0; n -= 2) sum = sum * z + 1.0 / n;
  return 2.0 * s * sum + static_cast<double>(exponent) * 0x1.62e42fefa39efp-1;
}

// x^y for x and y of at least 0. Small whole powers are products: a twentieth of the time, and no less exact.
constexpr double power(double x, double y) {
  if (y == 0.0) return 1.0;
  if (y <= 8.0 && y == static_cast<int>(y)) {
    double product = x;
    for (int n = 1; n < static_cast<int>(y); ++n) product *= x;
    return product;
  }
  return x < std::numeric_limits<double>::min() ? 0.0 : exponential(y * logarithm(x));
}

}  // namespace stiction::sim
