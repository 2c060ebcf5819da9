#include "sim/cam/characteristics.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>

#include "sim/cam/laws.hpp"

namespace stiction::sim::cam {
namespace {

using Function = std::function<double(double)>;

// How many samples show every turn of a piece's derivatives.
int samples_of(const Piece& piece) {
  double turns = 1.0 + static_cast<double>(piece.polynomial.size()) * 0.5;
  for (const Wave& wave : piece.waves)
    turns = std::max(turns, absolute(wave.rate) * piece.length() * piece.rate / std::numbers::pi);
  return static_cast<int>(16.0 * (turns + 2.0));
}

double zero_between(const Function& slope, double low, double high) {
  const bool rises = slope(low) < 0.0;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    ((slope(middle) < 0.0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void include(Extremes& extremes, double value, double place) {
  if (value < extremes.lowest.value) extremes.lowest = {value, place};
  if (value > extremes.highest.value) extremes.highest = {value, place};
}

// `function` and its derivative `slope` over one piece.
void include_piece(Extremes& all, const Piece& piece, const Function& function, const Function& slope) {
  const int count = samples_of(piece);
  double last = piece.begin;
  include(all, function(last), last);
  for (int k = 1; k <= count; ++k) {
    const double x = k == count ? piece.end : piece.begin + piece.length() * k / count;
    include(all, function(x), x);
    if ((slope(last) < 0.0) != (slope(x) < 0.0)) {
      const double peak = zero_between(slope, last, x);
      include(all, function(peak), peak);
    }
    last = x;
  }
}

Extremes start_with(double value, double place) { return {{value, place}, {value, place}}; }

}  // namespace

Extremes extremes(const Curve& curve, int order) {
  Extremes all = start_with(curve.derivative(curve.begin(), order), curve.begin());
  for (const Piece& piece : curve.pieces())
    include_piece(
        all, piece, [&](double x) { return piece.derivative(x, order); },
        [&](double x) { return piece.derivative(x, order + 1); });
  return all;
}

Extremes torque_extremes(const Curve& curve) {
  Extremes all = start_with(0.0, curve.begin());
  for (const Piece& piece : curve.pieces())
    include_piece(
        all, piece, [&](double x) { return piece.derivative(x, 1) * piece.derivative(x, 2); },
        [&](double x) {
          const double a = piece.derivative(x, 2);
          return a * a + piece.derivative(x, 1) * piece.derivative(x, 3);
        });
  return all;
}

std::array<double, 4> derivative_sizes(const Curve& curve) {
  std::array<double, 4> sizes{};
  const auto position = extremes(curve, 0);
  sizes[0] = position.highest.value - position.lowest.value;
  double scale = sizes[0];
  for (std::size_t order = 1; order < 4; ++order) {
    scale *= 3.0 / curve.length();
    sizes[order] = std::max(extremes(curve, static_cast<int>(order)).magnitude(), 1e-3 * scale);
  }
  return sizes;
}

std::vector<Jump> inner_jumps(const Curve& curve, double tolerance) {
  std::vector<Jump> jumps;
  const auto size = derivative_sizes(curve);
  for (std::size_t k = 1; k < curve.pieces().size(); ++k) {
    const Piece &before = curve.pieces()[k - 1], &behind = curve.pieces()[k];
    for (int order = 0; order < 4; ++order) {
      const double step = behind.derivative(behind.begin, order) - before.derivative(before.end, order);
      if (absolute(step) > tolerance * size[static_cast<std::size_t>(order)])
        jumps.push_back({behind.begin, order, step});
    }
  }
  return jumps;
}

std::vector<Jump> end_jumps(const Law& law, const LawValues& values, const Curve& curve, double tolerance) {
  std::vector<Jump> jumps;
  const auto check = [&](End end, double place, double sign) {
    const bool still = end == End::rest || end == End::reversal;
    const bool even = end == End::rest || end == End::constant_speed;
    const std::array<bool, 4> zero{false, still, even, even};
    for (int order = 1; order < 4; ++order) {
      const double value = curve.derivative(place, order);
      if (zero[static_cast<std::size_t>(order)] && absolute(value) > tolerance)
        jumps.push_back({place, order, sign * value});
    }
  };
  check(start_of(law, values), curve.begin(), 1.0);
  check(end_of(law, values), curve.end(), -1.0);
  return jumps;
}

bool Characteristics::jerks_without_bound() const {
  return std::any_of(jumps.begin(), jumps.end(), [](const Jump& jump) { return jump.order < 3; });
}

Characteristics characteristics(const Law& law, const LawValues& values, const Curve& curve) {
  Characteristics c;
  const auto bends = extremes(curve, 2);
  c.speed = extremes(curve, 1).magnitude();
  c.acceleration = std::max(bends.highest.value, 0.0);
  c.deceleration = std::min(bends.lowest.value, 0.0);
  c.jerk = extremes(curve, 3).magnitude();
  c.torque = torque_extremes(curve).magnitude();
  c.jumps = end_jumps(law, values, curve);
  const auto inner = inner_jumps(curve);
  c.jumps.insert(c.jumps.end(), inner.begin(), inner.end());
  std::stable_sort(c.jumps.begin(), c.jumps.end(), [](const Jump& a, const Jump& b) { return a.place < b.place; });
  return c;
}

double residual_amplitude(const Curve& curve, double r) {
  const double rate = 2.0 * std::numbers::pi * r / curve.length();
  double real = 0.0, imaginary = 0.0;
  const auto impulse = [&](double x, double step) {
    const auto [s, c] = sine_cosine(rate * (x - curve.begin()));
    real += step * c;
    imaginary += step * s;
  };
  for (const Jump& jump : inner_jumps(curve))
    if (jump.order == 1) impulse(jump.place, jump.height);
  for (const Piece& piece : curve.pieces()) {
    double turns = 1.0 + rate * piece.length() / std::numbers::pi;
    for (const Wave& wave : piece.waves) turns += absolute(wave.rate) * piece.length() * piece.rate / std::numbers::pi;
    // A bell is not analytic at its ends; it is flat there.
    const int parts = static_cast<int>(turns) + (piece.bells.empty() ? 0 : 24);
    for (int k = 0; k < parts; ++k) {
      const double begin = piece.begin + piece.length() * k / parts;
      const double end = piece.begin + piece.length() * (k + 1) / parts;
      const auto part = [&](bool cosine) {
        return integral(
            [&](double x) {
              const auto [s, c] = sine_cosine(rate * (x - curve.begin()));
              return piece.derivative(x, 2) * (cosine ? c : s);
            },
            begin, end);
      };
      real += part(true);
      imaginary += part(false);
    }
  }
  return square_root(real * real + imaginary * imaginary) / rate;
}

}  // namespace stiction::sim::cam
