// Polynomials of one's own: by coefficients, or by powers p_1 < p_2 < ... with as many derivatives zero at 1 as there
// are powers but one: C_i = product over j != i of p_j / (p_j - p_i) (Stoddart 1953).
#pragma once

#include <fmt/format.h>

#include "sim/cam/law.hpp"
#include "sim/cam/laws/one_sided_polynomial.hpp"

namespace stiction::sim::cam {

// Throws CamError for coefficients that do not rise to 1.
inline Curve free_polynomial(const LawValues& values) {
  const auto& given = values.find("coefficients")->second;
  std::vector<double> coefficients{0.0};
  double sum = 0.0;
  for (const double c : given) coefficients.push_back(c), sum += c;
  if (!(absolute(sum - 1.0) <= 1e-9))
    throw CamError(fmt::format("law polynomial: found coefficients with the sum {}; expected 1, the unit lift", sum));
  return of_polynomial(std::move(coefficients));
}

// Throws CamError for powers that are no rising whole numbers.
inline Curve power_polynomial(const LawValues& values) {
  const auto& powers = values.find("powers")->second;
  std::vector<double> coefficients(25, 0.0);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    if (powers[i] != static_cast<double>(static_cast<int>(powers[i])) || (i > 0 && powers[i] <= powers[i - 1]))
      throw CamError("law power_polynomial: found powers that are no rising whole numbers; expected e.g. [3, 4, 5]");
    double c = 1.0;
    for (const double other : powers)
      if (other != powers[i]) c *= other / (other - powers[i]);
    coefficients[static_cast<std::size_t>(powers[i])] = c;
  }
  return of_polynomial(std::move(coefficients));
}

}  // namespace stiction::sim::cam
