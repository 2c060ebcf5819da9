#include "sim/cam/piece.hpp"

#include <numbers>

namespace stiction::sim::cam {
namespace {

// n (n-1) ... of `order` factors.
double falling(std::size_t n, int order) {
  double product = 1.0;
  for (int k = 0; k < order; ++k) product *= static_cast<double>(n) - k;
  return product;
}

double polynomial_derivative(const std::vector<double>& coefficients, double t, int order) {
  double sum = 0.0;
  for (std::size_t n = coefficients.size(); n-- > static_cast<std::size_t>(order);)
    sum = sum * t + coefficients[n] * falling(n, order);
  return sum;
}

// Derivatives of a sine go around in four.
double wave_derivative(const Wave& wave, double t, int order) {
  const auto [sine, cosine] = sine_cosine(wave.rate * t + wave.phase);
  double value = wave.amplitude * (order % 2 == 0 ? sine : cosine);
  if (order % 4 >= 2) value = -value;
  for (int k = 0; k < order; ++k) value *= wave.rate;
  return value;
}

double power_of(double base, std::size_t exponent) {
  double product = 1.0;
  for (std::size_t k = 0; k < exponent; ++k) product *= base;
  return product;
}

// Adds the Taylor coefficients around `t`, in powers of t's distance.
void add_polynomial(const std::vector<double>& polynomial, double t, std::vector<Interval>& sum) {
  std::vector<Interval> shifted(polynomial.begin(), polynomial.end());
  for (std::size_t n = 0; n + 1 < shifted.size(); ++n)  // Horner's scheme, once for each power
    for (std::size_t k = shifted.size() - 1; k-- > n;) shifted[k] = shifted[k] + Interval(t) * shifted[k + 1];
  for (std::size_t n = 0; n < std::min(sum.size(), shifted.size()); ++n) sum[n] = sum[n] + shifted[n];
}

void add_wave(const Wave& wave, double t, std::vector<Interval>& sum) {
  const Interval angle = Interval(wave.rate) * Interval(t) + Interval(wave.phase);
  const Interval ahead = angle + Interval(0.5 * std::numbers::pi) + Interval::around(0.0, 1e-16);
  const Interval around[2] = {sine(angle), sine(ahead)};
  Interval factor = wave.amplitude;
  for (std::size_t n = 0; n < sum.size(); ++n) {
    sum[n] = sum[n] + (n % 4 >= 2 ? -factor : factor) * around[n % 2];
    factor = factor * Interval(wave.rate) / Interval(static_cast<double>(n + 1));
  }
}

// A bound of the terms beyond `order` of the derivative `of_order` of a polynomial or a sine, within `radius` of t.
double wave_remainder(const Wave& wave, double radius, std::size_t order, int of_order) {
  // Lagrange: amplitude * rate^(m) radius^(m - d) / (m - d)! with m = order + 1.
  double bound = absolute(wave.amplitude);
  for (int k = 0; k < of_order; ++k) bound *= absolute(wave.rate);
  for (std::size_t k = 1; k + static_cast<std::size_t>(of_order) <= order + 1; ++k)
    bound *= absolute(wave.rate) * radius / static_cast<double>(k);
  return bound * (1.0 + 1e-13);
}

double polynomial_remainder(const std::vector<double>& polynomial, double farthest, double radius, std::size_t order,
                            int of_order) {
  // The same with the derivative of order + 1 bounded by the magnitudes of its terms at the farthest place.
  double bound = 0.0;
  for (std::size_t n = order + 1; n < polynomial.size(); ++n)
    bound += absolute(polynomial[n]) * falling(n, static_cast<int>(order + 1)) * power_of(farthest, n - order - 1);
  for (std::size_t k = 1; k + static_cast<std::size_t>(of_order) <= order + 1; ++k)
    bound *= radius / static_cast<double>(k);
  return bound * (1.0 + 1e-13);
}

// Whether a part of a bell begins so near to its end, in comparison with its length, that no circle around its middle
// holds it and leaves out the end: there every derivative is small, and the motion itself is the remainder.
bool begins_flat(double t, double radius) { return t - radius <= 0.05 * (t + radius); }

}  // namespace

double Piece::chain(int order) const {
  double product = 1.0;
  for (int k = 0; k < order; ++k) product *= from_end ? -rate : rate;
  return product;
}

double Piece::derivative(double x, int order) const {
  const double t = local(x);
  double sum = polynomial_derivative(polynomial, t, order);
  for (const Wave& wave : waves) sum += wave_derivative(wave, t, order);
  for (const Bell& bell : bells) sum += bell.derivative(t, order);
  return sum * chain(order);
}

TaylorModel taylor_model(const Piece& piece, double begin, double end, std::size_t order) {
  const double middle = 0.5 * (begin + end), t = piece.local(middle);
  TaylorModel model{middle, 0.5 * (end - begin), std::vector<Interval>(order + 1, Interval(0.0)), {}};
  const double radius = model.radius * piece.rate * (1.0 + 1e-15);
  add_polynomial(piece.polynomial, t, model.coefficients);
  for (const Wave& wave : piece.waves) add_wave(wave, t, model.coefficients);
  for (int d = 0; d < 3; ++d) {
    double bound = polynomial_remainder(piece.polynomial, t + radius, radius, order, d);
    for (const Wave& wave : piece.waves) bound += wave_remainder(wave, radius, order, d);
    for (const Bell& bell : piece.bells)
      bound += begins_flat(t, radius) ? bell.bound_at_end(t + radius, d) : bell.remainder(t, radius, order, d);
    model.remainder[d] = bound * absolute(piece.chain(d)) * (1.0 + 1e-14);
  }
  for (const Bell& bell : piece.bells) {
    if (begins_flat(t, radius)) continue;
    const auto series = bell.taylor(t, order);
    for (std::size_t n = 0; n <= order; ++n) model.coefficients[n] = model.coefficients[n] + series[n];
  }
  Interval chain = 1.0;
  for (Interval& coefficient : model.coefficients) {
    coefficient = coefficient * chain;
    chain = chain * Interval(piece.from_end ? -piece.rate : piece.rate);
  }
  return model;
}

Piece placed(const Piece& piece, const Placement& placement) {
  Piece result = piece;
  result.begin = placement.begin + placement.stretch * (piece.begin - placement.from);
  result.end = placement.begin + placement.stretch * (piece.end - placement.from);
  result.rate = piece.rate / placement.stretch;
  for (double& c : result.polynomial) c *= placement.gain;
  for (Wave& wave : result.waves) wave.amplitude *= placement.gain;
  for (Bell& bell : result.bells) bell = bell.scaled(placement.gain);
  if (result.polynomial.empty()) result.polynomial.push_back(0.0);
  result.polynomial[0] += placement.offset;
  return result;
}

Piece mirrored(const Piece& piece, double about) {
  Piece result = piece;
  result.begin = about - piece.end;
  result.end = about - piece.begin;
  result.from_end = !piece.from_end;
  return result;
}

void add_line(Piece& piece, double slope, double from) {
  const double start = piece.from_end ? piece.end : piece.begin;
  if (piece.polynomial.size() < 2) piece.polynomial.resize(2, 0.0);
  piece.polynomial[0] += slope * (start - from);
  piece.polynomial[1] += slope / (piece.from_end ? -piece.rate : piece.rate);
}

}  // namespace stiction::sim::cam
