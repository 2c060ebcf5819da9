#include "host/fleet/scatter.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stiction::host {

// Recurrence up to 8, then the asymptotic series (Abramowitz, Stegun, 6.3.18 and 6.4.12): 1e-10.
double digamma(double x) {
  double sum = 0.0;
  for (; x < 8.0; x += 1.0) sum -= 1.0 / x;
  const double s = 1.0 / (x * x);
  return sum + std::log(x) - 0.5 / x - s * (1.0 / 12.0 - s * (1.0 / 120.0 - s * (1.0 / 252.0 - s / 240.0)));
}

double trigamma(double x) {
  double sum = 0.0;
  for (; x < 8.0; x += 1.0) sum += 1.0 / (x * x);
  const double s = 1.0 / (x * x);
  return sum + 1.0 / x + 0.5 * s + s / x * (1.0 / 6.0 - s * (1.0 / 30.0 - s * (1.0 / 42.0 - s / 30.0)));
}

double inverse_trigamma(double y) {
  // trigamma falls from infinity to 0 with 1/x < trigamma(x) < 1/x + 1/x^2.
  double low = 1.0 / (y + 1.0), high = 1.0 / y + 1.0;
  while (trigamma(low) < y) low *= 0.5;
  for (int k = 0; k < 200 && high - low > 1e-12 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (trigamma(middle) > y ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Scatter common_scatter(std::span<const Scatter> axes) {
  std::vector<double> logs;
  double expected = 0.0, freedom = 0.0;
  for (const auto& axis : axes) {
    if (axis.freedom <= 0.0 || axis.variance <= 0.0) continue;
    const double half = 0.5 * axis.freedom;
    logs.push_back(std::log(axis.variance) - digamma(half) + std::log(half));
    expected += trigamma(half);
    freedom += axis.freedom;
  }
  if (logs.size() < 3) return {};
  const auto count = static_cast<double>(logs.size());
  double mean = 0.0, square = 0.0;
  for (const double each : logs) mean += each / count;
  for (const double each : logs) square += (each - mean) * (each - mean) / (count - 1.0);
  const double beyond = square - expected / count;
  if (beyond <= 0.0) return {std::exp(mean), freedom};
  const double common = std::min(2.0 * inverse_trigamma(beyond), freedom);
  return {std::exp(mean + digamma(0.5 * common) - std::log(0.5 * common)), common};
}

Scatter moderated(const Scatter& own, const Scatter& common) {
  const double freedom = own.freedom + common.freedom;
  if (freedom <= 0.0) return {};
  return {(own.freedom * own.variance + common.freedom * common.variance) / freedom, freedom};
}

}  // namespace stiction::host
