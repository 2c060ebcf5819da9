// Rise and return in one law (type 00100 of Dostrasil 2014, on [0, 1]), and periodic ones without a dwell (type 10101).
#pragma once

#include <numbers>

#include "sim/cam/law.hpp"
#include "sim/cam/laws/one_sided_sine.hpp"

namespace stiction::sim::cam {

// 4^n x^n (1 - x)^n.
template <int n>
Curve bump_polynomial(const LawValues&) {
  std::vector<double> coefficients(static_cast<std::size_t>(n), 0.0);
  double factor = 1.0;
  for (int k = 0; k < n; ++k) factor *= 4.0;
  for (int k = 0; k <= n; ++k) {
    coefficients.push_back(factor);
    factor *= -static_cast<double>(n - k) / (k + 1);
  }
  return even({polynomial_piece(0.0, 0.5, std::move(coefficients))});
}

// A sum of sines that is even around 1/2.
inline Curve even_waves(double constant, std::vector<Wave> waves) {
  Piece half = polynomial_piece(0.0, 0.5, {constant});
  half.waves = std::move(waves);
  return even({half});
}

inline Curve full_harmonic(const LawValues&) { return even_waves(0.5, {minus_cosine(0.5, 2.0 * std::numbers::pi)}); }

// sin^4 pi x = 3/8 - 1/2 cos 2 pi x + 1/8 cos 4 pi x.
inline Curve sine_fourth(const LawValues&) {
  constexpr double pi = std::numbers::pi;
  return even_waves(0.375, {minus_cosine(0.5, 2.0 * pi), minus_cosine(-0.125, 4.0 * pi)});
}

// sin^3 pi x = 3/4 sin pi x - 1/4 sin 3 pi x.
inline Curve sine_cube(const LawValues&) {
  constexpr double pi = std::numbers::pi;
  return even_waves(0.0, {{0.75, pi, 0.0}, {-0.25, 3.0 * pi, 0.0}});
}

// f(2x) and back, f(2 - 2x).
template <Curve (*law)(const LawValues&)>
Curve there_and_back(const LawValues& values) {
  return even(law(values).placed({.stretch = 0.5}).pieces());
}

// (1 - cos) / 2 + e sin (1 - cos) of 2 pi x, over its peak: where (1/2) sin a + e (cos a - cos 2a) = 0, by bisection.
inline Curve two_harmonic_return(const LawValues& values) {
  constexpr double pi = std::numbers::pi;
  const double e = value(values, "e");
  const auto lift = [&](double a) {
    const auto [s, c] = sine_cosine(a);
    return 0.5 * (1.0 - c) + e * s * (1.0 - c);
  };
  const auto slope = [&](double a) {
    return 0.5 * sine_cosine(a).sine + e * (sine_cosine(a).cosine - sine_cosine(2.0 * a).cosine);
  };
  double low = 0.5 * pi, high = 1.5 * pi;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0.0 ? low : high) = middle;
  }
  const double peak = lift(0.5 * (low + high));
  return of_waves({0.5 / peak},
                  {minus_cosine(0.5 / peak, 2.0 * pi), {e / peak, 2.0 * pi, 0.0}, {-0.5 * e / peak, 4.0 * pi, 0.0}});
}

}  // namespace stiction::sim::cam
