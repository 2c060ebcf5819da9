// Integrals by Gauss and Legendre with 16 points: exact for polynomials of degree 31 (Abramowitz and Stegun, 25.4.29,
// table 25.4).
#pragma once

#include <array>
#include <cstddef>

namespace stiction::sim::cam {

struct QuadraturePoint {
  double place;   // -1 to 1
  double weight;  // the sum of all is 2
};

inline constexpr std::array<QuadraturePoint, 8> half_of_quadrature{{
    {0.0950125098376374402, 0.1894506104550684963},
    {0.2816035507792589132, 0.1826034150449235889},
    {0.4580167776572273863, 0.1691565193950025382},
    {0.6178762444026437484, 0.1495959888165767321},
    {0.7554044083550030339, 0.1246289712555338720},
    {0.8656312023878317439, 0.0951585116824927848},
    {0.9445750230732325761, 0.0622535239386478929},
    {0.9894009349916499326, 0.0271524594117540949},
}};

// The integral of `function`, double or any type that adds and takes a factor, from `begin` to `end`.
template <class Function>
auto integral(const Function& function, double begin, double end) {
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  auto sum =
      (function(middle - half * half_of_quadrature[0].place) + function(middle + half * half_of_quadrature[0].place)) *
      half_of_quadrature[0].weight;
  for (std::size_t k = 1; k < half_of_quadrature.size(); ++k) {
    const auto [place, weight] = half_of_quadrature[k];
    sum = sum + (function(middle - half * place) + function(middle + half * place)) * weight;
  }
  return sum * half;
}

}  // namespace stiction::sim::cam
