// Sines for tasks with one end at rest, at constant speed or at a reversal (VDI 2143, part 1; the double harmonic and
// the harmonic combination after Rothbart 1956).
#pragma once

#include <numbers>

#include "sim/cam/acceleration_profile.hpp"
#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

// -amplitude cos(rate x): a cosine is a sine a quarter of a turn ahead.
inline Wave minus_cosine(double amplitude, double rate) { return {amplitude, rate, -0.5 * std::numbers::pi}; }

inline Curve of_waves(std::vector<double> polynomial, std::vector<Wave> waves) {
  Piece piece = polynomial_piece(0.0, 1.0, std::move(polynomial));
  piece.waves = std::move(waves);
  return Curve({piece});
}

// 1/2 [(1 - cos pi x) - 1/4 (1 - cos 2 pi x)].
inline Curve double_harmonic(const LawValues&) {
  constexpr double pi = std::numbers::pi;
  return of_waves({0.375}, {minus_cosine(0.5, pi), minus_cosine(-0.125, 2.0 * pi)});
}

// Acceleration of half a sine up to 0.4, then of a quarter of a sine that brakes to the reversal.
inline Curve harmonic_combination(const LawValues&) {
  AccelerationProfile whole;
  whole.sine(0.4, 1.0, std::numbers::pi / 0.4, 0.0);
  whole.sine(0.6, -2.0 / 3.0, 0.5 * std::numbers::pi / 0.6, 0.0);
  return Curve(whole.scaled_to(1.0));
}

// Rest to the speed 2: the first half of a sloping sine.
inline Curve half_cycloid(const LawValues&) {
  return of_waves({0.0, 1.0}, {{-1.0 / std::numbers::pi, std::numbers::pi, 0.0}});
}

// Reversal to the speed pi / 2: 1 - cos(pi x / 2).
inline Curve half_harmonic(const LawValues&) { return of_waves({1.0}, {minus_cosine(1.0, 0.5 * std::numbers::pi)}); }

}  // namespace stiction::sim::cam
