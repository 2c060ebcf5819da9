#include "host/identify/filter.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
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
// each waits for its own last output only, so that they work side by side. Value: a double, or several columns'.
template <class Value>
void filter_forward(const Lowpass& filter, std::vector<Value>& values, const Value& start) {
  struct State {
    FilterSection section;
    Value first, second;
  };
  std::vector<State> states;
  Value level = start;
  for (const auto& s : filter.sections) {
    const Value settled = level * (s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2);
    states.push_back({s, settled - s.b0 * level, s.b2 * level - s.a2 * settled});
    level = settled;
  }
  for (Value& value : values)
    for (auto& [s, first, second] : states) {
      const Value out = s.b0 * value + first;
      first = s.b1 * value - s.a1 * out + second;
      second = s.b2 * value - s.a2 * out;
      value = out;
    }
}

// `value(i)` of `size` samples, filtered with `pad` samples in front of them and behind.
template <class Value, class At>
std::vector<Value> both_ways(const Lowpass& filter, std::size_t size, std::size_t pad, At&& value) {
  std::vector<Value> extended;
  extended.reserve(size + 2 * pad);
  const Value front = value(0), back = value(size - 1);
  for (std::size_t i = pad; i > 0; --i) extended.push_back(2.0 * front - value(i));
  for (std::size_t i = 0; i < size; ++i) extended.push_back(value(i));
  for (std::size_t i = 1; i <= pad; ++i) extended.push_back(2.0 * back - value(size - 1 - i));
  for (int way = 0; way < 2; ++way) {
    filter_forward<Value>(filter, extended, Value(extended.front()));
    std::reverse(extended.begin(), extended.end());
  }
  return extended;
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
  const auto extended = both_ways<double>(filter, values.size(), pad, [&](std::size_t i) { return values[i]; });
  return {extended.begin() + static_cast<std::ptrdiff_t>(pad), extended.end() - static_cast<std::ptrdiff_t>(pad)};
}

std::vector<std::vector<double>> filter_both_ways(const Lowpass& filter,
                                                  std::span<const std::span<const double>> columns,
                                                  std::size_t padding) {
  constexpr std::size_t lanes = 4;
  using Lanes = Eigen::Array<double, lanes, 1>;
  std::vector<std::vector<double>> filtered;
  for (std::size_t first = 0; first < columns.size(); first += lanes) {
    const std::size_t count = std::min(lanes, columns.size() - first), size = columns[first].size();
    if (count == 1 || size == 0) {
      for (std::size_t c = 0; c < count; ++c) filtered.push_back(filter_both_ways(filter, columns[first + c], padding));
      continue;
    }
    const std::size_t pad = std::min(padding, size - 1);
    std::array<const double*, lanes> from{};
    for (std::size_t c = 0; c < lanes; ++c) from[c] = columns[first + std::min(c, count - 1)].data();
    const auto extended = both_ways<Lanes>(
        filter, size, pad, [&](std::size_t i) { return Lanes(from[0][i], from[1][i], from[2][i], from[3][i]); });
    for (std::size_t c = 0; c < count; ++c) {
      auto& column = filtered.emplace_back(size);
      for (std::size_t i = 0; i < size; ++i) column[i] = extended[pad + i][static_cast<Eigen::Index>(c)];
    }
  }
  return filtered;
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

Derivatives derivatives(std::span<const double> values, double step) {
  // Fornberg 1988, table 1: order of accuracy 10.
  constexpr std::array<double, 5> first{5.0 / 6.0, -5.0 / 21.0, 5.0 / 84.0, -5.0 / 504.0, 1.0 / 1260.0};
  constexpr std::array<double, 5> second{5.0 / 3.0, -5.0 / 21.0, 5.0 / 126.0, -5.0 / 1008.0, 1.0 / 3150.0};
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](std::ptrdiff_t i) {
    const auto inside = [&](std::ptrdiff_t k) {
      return values[static_cast<std::size_t>(std::clamp(k, std::ptrdiff_t{0}, n - 1))];
    };
    if (i < 0) return 2.0 * inside(0) - inside(-i);
    if (i >= n) return 2.0 * inside(n - 1) - inside(2 * (n - 1) - i);
    return inside(i);
  };
  Derivatives d{std::vector<double>(values.size()), std::vector<double>(values.size())};
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double slope = 0.0, bend = 0.0;
    for (std::ptrdiff_t k = 1; k <= 5; ++k) {
      const double ahead = at(i + k) - at(i), behind = at(i) - at(i - k);
      slope += first[static_cast<std::size_t>(k - 1)] * (ahead + behind);
      bend += second[static_cast<std::size_t>(k - 1)] * (ahead - behind);
    }
    d.first[static_cast<std::size_t>(i)] = slope / step;
    d.second[static_cast<std::size_t>(i)] = bend / (step * step);
  }
  return d;
}

std::vector<double> every(std::span<const double> values, std::size_t ratio) {
  std::vector<double> kept;
  if (values.empty()) return kept;
  kept.reserve(values.size() / ratio + 1);
  for (std::size_t i = (values.size() - 1) % ratio; i < values.size(); i += ratio) kept.push_back(values[i]);
  return kept;
}

}  // namespace stiction::host
