// f = x - (1/2 pi) sum of b_k sin 2 pi k x: the sloping sine (b_1 = 1; Bestehorn's), and the laws of few harmonics
// that keep a driven vibration small (Gutman and Freudenstein; see Koster 1974 for the
// vibration. The coefficients were recalled and their boundary conditions checked).
#pragma once

#include <array>
#include <numbers>

#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

struct Harmonic {
  int order;      // k
  double weight;  // b_k
};

template <std::size_t count>
Curve harmonic_series(const std::array<Harmonic, count>& harmonics) {
  Piece half = polynomial_piece(0.0, 0.5, {0.0, 1.0});
  for (const auto& [order, weight] : harmonics)
    half.waves.push_back({-weight / (2.0 * std::numbers::pi), 2.0 * std::numbers::pi * order, 0.0});
  return symmetric({half});
}

inline Curve sloping_sine(const LawValues&) { return harmonic_series<1>({{{1, 1.0}}}); }
inline Curve gutman(const LawValues&) { return harmonic_series<2>({{{1, 15.0 / 16.0}, {3, 1.0 / 48.0}}}); }
inline Curve freudenstein_3(const LawValues&) { return harmonic_series<2>({{{1, 27.0 / 28.0}, {3, 1.0 / 84.0}}}); }
inline Curve freudenstein_5(const LawValues&) {
  constexpr double first = 1125.0 / 1192.0;
  return harmonic_series<3>({{{1, first}, {3, first / 54.0}, {5, first / 1250.0}}});
}
inline Curve two_harmonics(const LawValues&) { return harmonic_series<2>({{{1, 4.0 / 3.0}, {2, -1.0 / 6.0}}}); }

}  // namespace stiction::sim::cam
