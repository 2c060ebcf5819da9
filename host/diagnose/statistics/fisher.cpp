#include "host/diagnose/statistics/fisher.hpp"

#include <cmath>

namespace stiction::host {
namespace {

double fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
  d = 1.0 / (std::abs(d) < tiny ? tiny : d);
  double h = d;
  for (int m = 1; m < 500; ++m) {
    const auto step = [&](double coefficient) {
      d = 1.0 + coefficient * d;
      c = 1.0 + coefficient / c;
      d = 1.0 / (std::abs(d) < tiny ? tiny : d);
      if (std::abs(c) < tiny) c = tiny;
      h *= d * c;
      return d * c;
    };
    const double twice = 2.0 * m;
    step(m * (b - m) * x / ((a + twice - 1.0) * (a + twice)));
    if (std::abs(step(-(a + m) * (a + b + m) * x / ((a + twice) * (a + twice + 1.0))) - 1.0) < 1e-14) break;
  }
  return h;
}

// Regularised incomplete beta function.
double beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? front * fraction(a, b, x) / a : 1.0 - front * fraction(b, a, 1.0 - x) / b;
}

}  // namespace

double fisher_tail(double f, double above, double below) {
  if (!(f > 0.0)) return 1.0;
  return beta(0.5 * below, 0.5 * above, below / (below + above * f));
}

double student_limit(double freedom) {
  double low = 1.9, high = 13.0;  // of an endless number of degrees, and of one
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    (student_tails(middle, freedom) > 0.05 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace stiction::host
