#include "host/identify/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

void check(int order, double edge) {
  if (order < 1 || !(edge > 0.0 && edge < 1.0))
    throw std::invalid_argument(
        fmt::format("lowpass of order {} with edge {:g}: expected order >= 1, edge in (0, 1)", order, edge));
}

// The analogue pole `pole` of a prototype with edge 1 rad/s, taken to the edge and through the bilinear transform.
Complex digital(Complex pole, double edge) {
  const Complex scaled = pole * std::tan(0.5 * std::numbers::pi * edge);
  return (1.0 + scaled) / (1.0 - scaled);
}

// All zeros lie at half the sampling rate; each section passes standstill unchanged.
FilterSection section_of_pair(Complex pole) {
  const double a1 = -2.0 * pole.real(), a2 = std::norm(pole);
  const double b = 0.25 * (1.0 + a1 + a2);
  return {b, 2.0 * b, b, a1, a2};
}
FilterSection section_of_single(double pole) {
  const double b = 0.5 * (1.0 - pole);
  return {b, b, 0.0, -pole, 0.0};
}

// `prototype(theta)`: the pole at the angle theta in (0, pi/2) of the upper half plane, or at 0 of the real axis.
template <class Prototype>
Lowpass design(int order, double edge, double gain, Prototype&& prototype) {
  check(order, edge);
  Lowpass filter{{}, order};
  for (int m = order - 1; m > 0; m -= 2)
    filter.sections.push_back(section_of_pair(digital(prototype(0.5 * std::numbers::pi * m / order), edge)));
  if (order % 2 == 1) filter.sections.push_back(section_of_single(digital(prototype(0.0), edge).real()));
  auto& first = filter.sections.front();
  first.b0 *= gain;
  first.b1 *= gain;
  first.b2 *= gain;
  return filter;
}

// In place, from the state that a constant input of `start` would have left. Sample by sample through all sections:
// each waits for its own last output only, so that they work side by side.
void filter_forward(const Lowpass& filter, std::vector<double>& values, double start) {
  struct State {
    FilterSection section;
    double first, second;
  };
  std::vector<State> states;
  double level = start;
  for (const auto& s : filter.sections) {
    const double settled = level * (s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2);
    states.push_back({s, settled - s.b0 * level, s.b2 * level - s.a2 * settled});
    level = settled;
  }
  for (double& value : values)
    for (auto& [s, first, second] : states) {
      const double out = s.b0 * value + first;
      first = s.b1 * value - s.a1 * out + second;
      second = s.b2 * value - s.a2 * out;
      value = out;
    }
}

}  // namespace

Lowpass butterworth(int order, double edge) {
  return design(order, edge, 1.0, [](double theta) { return -std::polar(1.0, theta); });
}

Lowpass chebyshev(int order, double ripple_db, double edge) {
  const double epsilon = std::sqrt(std::pow(10.0, 0.1 * ripple_db) - 1.0);
  const double mu = std::asinh(1.0 / epsilon) / std::max(order, 1);
  // An even order stands at the ripple's lower end at standstill.
  const double gain = order % 2 == 0 ? std::pow(10.0, -ripple_db / 20.0) : 1.0;
  return design(order, edge, gain, [mu](double theta) { return -std::sinh(Complex(mu, theta)); });
}

std::size_t default_padding(const Lowpass& filter) { return 3 * static_cast<std::size_t>(filter.order); }

std::vector<double> filter_both_ways(const Lowpass& filter, std::span<const double> values, std::size_t padding) {
  if (values.empty()) return {};
  const std::size_t pad = std::min(padding, values.size() - 1);
  std::vector<double> extended;
  extended.reserve(values.size() + 2 * pad);
  for (std::size_t i = pad; i > 0; --i) extended.push_back(2.0 * values.front() - values[i]);
  extended.insert(extended.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= pad; ++i) extended.push_back(2.0 * values.back() - values[values.size() - 1 - i]);
  for (int way = 0; way < 2; ++way) {
    filter_forward(filter, extended, extended.front());
    std::reverse(extended.begin(), extended.end());
  }
  return {extended.begin() + static_cast<std::ptrdiff_t>(pad), extended.end() - static_cast<std::ptrdiff_t>(pad)};
}

std::vector<double> central_difference(std::span<const double> values, double step, int points) {
  const std::size_t n = values.size();
  std::vector<double> slope(n, 0.0);
  if (n < 2) return slope;
  slope.front() = (values[1] - values[0]) / step;
  slope.back() = (values[n - 1] - values[n - 2]) / step;
  const std::size_t half = points == 7 ? 3 : 1;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const auto pair = [&](std::size_t k) { return values[i + k] - values[i - k]; };
    slope[i] = half == 1 || i < half || i + half >= n ? pair(1) / (2.0 * step)
                                                      : (45.0 * pair(1) - 9.0 * pair(2) + pair(3)) / (60.0 * step);
  }
  return slope;
}

std::vector<double> every(std::span<const double> values, std::size_t ratio) {
  std::vector<double> kept;
  if (values.empty()) return kept;
  kept.reserve(values.size() / ratio + 1);
  for (std::size_t i = (values.size() - 1) % ratio; i < values.size(); i += ratio) kept.push_back(values[i]);
  return kept;
}

}  // namespace stiction::host
