// The polynomial of degree 2 n - 1 with n - 1 derivatives zero at both ends, and the straight line as its first:
// f = x^n sum over k < n of C(n-1+k, k) C(2n-1, n-1-k) (-x)^k. n = 2 is 3x^2 - 2x^3, n = 3 the 3-4-5 polynomial, n = 4
// 4-5-6-7 (VDI 2143, part 1; Norton, Cam Design and Manufacturing Handbook).
#pragma once

#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

template <int n>
Curve smooth_polynomial(const LawValues&) {
  const auto choose = [](int from, int count) {
    double product = 1.0;
    for (int k = 1; k <= count; ++k) product = product * (from - count + k) / k;
    return product;
  };
  std::vector<double> coefficients(static_cast<std::size_t>(n), 0.0);
  for (int k = 0; k < n; ++k)
    coefficients.push_back((k % 2 == 0 ? 1.0 : -1.0) * choose(n - 1 + k, k) * choose(2 * n - 1, n - 1 - k));
  return symmetric({polynomial_piece(0.0, 0.5, std::move(coefficients))});
}

}  // namespace stiction::sim::cam
