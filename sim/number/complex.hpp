// Functions of complex numbers over the project's own of real ones, so that they have the same bits wherever they are
// compiled: those of <complex> call a library of mathematics, and divide in a way of their own in each library.
#pragma once

#include <complex>

#include "sim/number/arc.hpp"
#include "sim/number/arithmetic.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim {

// The length of `z`, as long as its square is a normal number.
inline double magnitude(std::complex<double> z) { return square_root(z.real() * z.real() + z.imag() * z.imag()); }

// The angle of `z` from the real axis, from -pi to pi rad.
inline double angle_of(std::complex<double> z) { return arc_tangent(z.imag(), z.real()); }

// `size` in the direction of `angle`, rad.
inline std::complex<double> in_direction(double size, double angle) {
  const auto [s, c] = sine_cosine(angle);
  return {size * c, size * s};
}

// e^z.
inline std::complex<double> exponential(std::complex<double> z) {
  return in_direction(exponential(z.real()), z.imag());
}

// `above` over `below`, as long as the square of `below` is a normal number.
inline std::complex<double> quotient(std::complex<double> above, std::complex<double> below) {
  const double square = below.real() * below.real() + below.imag() * below.imag();
  return {(above.real() * below.real() + above.imag() * below.imag()) / square,
          (above.imag() * below.real() - above.real() * below.imag()) / square};
}

}  // namespace stiction::sim
