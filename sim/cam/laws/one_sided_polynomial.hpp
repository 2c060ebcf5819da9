// Polynomials for tasks with one end at rest, or with none (VDI 2143, part 1), and the asymmetric polynomial of 6th
// degree. The coefficients of the 8th power, a rise to a reversal, are recalled and rounded; its boundary conditions
// are checked.
#pragma once

#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

inline Curve of_polynomial(std::vector<double> coefficients) {
  return Curve({polynomial_piece(0.0, 1.0, std::move(coefficients))});
}

// f(x) -> 1 - f(1 - x).
inline Curve mirror_of(const Curve& law) { return law.mirrored().placed({.gain = -1.0, .offset = 1.0}); }

inline Curve linear(const LawValues&) { return of_polynomial({0.0, 1.0}); }
inline Curve asymmetric_sixth(const LawValues&) {
  return of_polynomial({0.0, 0.0, 0.0, 10.0 + 6.4, -15.0 - 19.2, 6.0 + 19.2, -6.4});
}
inline Curve eighth_power(const LawValues&) {
  return of_polynomial({0.0, 0.0, 0.0, 6.09755, 0.0, -20.7804, 26.73155, -13.60965, 2.56095});
}
inline Curve quartic_rest_reversal(const LawValues&) { return of_polynomial({0.0, 0.0, 0.0, 4.0, -3.0}); }
inline Curve quintic_rest_reversal(const LawValues&) { return of_polynomial({0.0, 0.0, 0.0, 0.0, 5.0, -4.0}); }
inline Curve quartic_reversals(const LawValues&) { return of_polynomial({0.0, 0.0, 2.0, 0.0, -1.0}); }
inline Curve quartic_rest_speed(const LawValues&) { return of_polynomial({0.0, 0.0, 0.0, 2.0, -1.0}); }
inline Curve half_parabola(const LawValues&) { return of_polynomial({0.0, 0.0, 1.0}); }

// The mirror of a law of this table.
template <Curve (*law)(const LawValues&)>
Curve mirror(const LawValues& values) {
  return mirror_of(law(values));
}

}  // namespace stiction::sim::cam
