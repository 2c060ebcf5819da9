// The motion whose speed is exp(-k / (4 x (1 - x))): every derivative is zero at both ends of [0, 1]. The function is
// the standard example of one that is smooth and has no Taylor series; as a lift law it is this project's own. y has no
// closed form: it is a sum of integrals over octaves [2^-j, 2^-j+1], each by 16 points. The singularity lies a whole
// octave away from each, so that their error is below 1e-16 of the integral.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/cam/interval.hpp"
#include "sim/cam/quadrature.hpp"

namespace stiction::sim::cam {

// exp(-k / (4 x (1 - x))) as a Taylor series around `x`, in powers of the distance, up to the power `order`. `k` is
// positive; x lies strictly between 0 and 1. With h = -k/4 (1/x + 1/(1-x)) the n-th coefficient of e^h is the sum of
// j/n h_j g_(n-j) over j. Work grows with the square of `order`.
template <class Number>
std::vector<Number> bell_series(double k, double x, std::size_t order) {
  const Number left = Number(1.0) / Number(x), right = Number(1.0) / (Number(1.0) - Number(x));
  std::vector<Number> exponent, series;
  Number left_power = left, right_power = right;
  for (std::size_t n = 0; n <= order; ++n) {
    exponent.push_back(Number(-0.25 * k) * (left_power + right_power));
    left_power = -(left_power * left);
    right_power = right_power * right;
  }
  series.push_back(exponential(exponent[0]));
  for (std::size_t n = 1; n <= order; ++n) {
    Number sum(0.0);
    for (std::size_t j = 1; j <= n; ++j) sum = sum + Number(static_cast<double>(j)) * exponent[j] * series[n - j];
    series.push_back(sum / Number(static_cast<double>(n)));
  }
  return series;
}

class Bell {
 public:
  // amplitude * (the integral of exp(-k / (4 t (1 - t))) from 0 to t) / (the same to 1), for t from 0 to 1/2. `k`: 0.25
  // to 20.
  Bell(double amplitude, double k) : amplitude_(amplitude), k_(k) {
    double sum = 0.0;
    for (std::size_t j = 0; j < octaves; ++j) {
      below_[j] = sum;
      sum += integral([&](double t) { return speed(t); }, 0.5 * place(j), place(j));
    }
    whole_ = 2.0 * sum;
  }

  double amplitude() const { return amplitude_; }
  Bell scaled(double gain) const {
    Bell result = *this;
    result.amplitude_ *= gain;
    return result;
  }

  // The derivative of that `order` at `t`; order 0 is the motion itself.
  double derivative(double t, int order) const {
    if (t <= place(0) * 0.5) return 0.0;
    const double gain = amplitude_ / whole_;
    if (order == 0) return gain * integral_to(t);
    if (order == 1) return gain * speed(t);
    const auto series = bell_series<double>(k_, t, static_cast<std::size_t>(order - 1));
    double factorial = 1.0;
    for (int n = 2; n < order; ++n) factorial *= n;
    return gain * factorial * series.back();
  }

  // Taylor coefficients 0 to `order` around `t`, each as an interval that holds the exact one.
  std::vector<Interval> taylor(double t, std::size_t order) const {
    const Interval gain = Interval(amplitude_) / Interval::around(whole_, 1e-14 * whole_);
    std::vector<Interval> result{Interval::around(derivative(t, 0), 1e-15 * absolute(amplitude_))};
    if (t <= place(0) * 0.5) {
      result.resize(order + 1, Interval::around(0.0, 1e-300));
      return result;
    }
    const auto series = bell_series<Interval>(k_, t, order);
    for (std::size_t n = 1; n <= order; ++n) result.push_back(gain * series[n - 1] / Interval(static_cast<double>(n)));
    return result;
  }

  // A bound of |remainder| of the series of that `order` for the derivative `of_order` within `radius` of `t`, by
  // Cauchy's estimate: on a circle of radius R around t the real part of 1/z is at least 1/(t + R), so that the speed
  // is at most exp(-k/4 / (t + R)); its n-th coefficient at most that over R^n. R is the best of a few.
  double remainder(double t, double radius, std::size_t order, int of_order) const {
    double best = std::numeric_limits<double>::infinity();
    const double nearest = std::min(t, 1.0 - t);
    for (const double share : {0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98}) {
      const double circle = share * nearest;
      if (circle <= radius * 1.05) continue;
      best = std::min(best, tail(radius, circle, order, of_order) * exponential(-0.25 * k_ / (t + circle)));
    }
    return best * absolute(amplitude_) / whole_ * (1.0 + 1e-9);
  }

  // A bound of |derivative| of `of_order`, 0 to 2, from 0 to `t` below 1/4: of the motion and its speed by their rise,
  // of the acceleration k/4 (1/x^2 - 1/(1-x)^2) g <= k/(4 x^2) e^(-k/(4x)), which rises up to x = k/8.
  double bound_at_end(double t, int of_order) const {
    const double gain = absolute(amplitude_) / whole_ * (1.0 + 1e-9);
    if (of_order == 0) return gain * t * speed(t);
    if (of_order == 1) return gain * speed(t);
    const double x = std::min(t, 0.125 * k_);
    return gain * 0.25 * k_ / (x * x) * exponential(-0.25 * k_ / x);
  }

 private:
  // The sum over n > order of the terms of the derivative `of_order`: n-th coefficients of the motion are at most
  // R^(1-n) / n.
  static double tail(double radius, double circle, std::size_t order, int of_order) {
    const double ratio = radius / circle;
    double term = circle;
    for (std::size_t n = 0; n <= order; ++n) term *= ratio;
    double sum = 0.0;
    for (std::size_t n = order + 1; n < order + 2000; ++n, term *= ratio) {
      const auto count = static_cast<double>(n);
      double factor = 1.0 / count;
      for (int d = 0; d < of_order; ++d) factor *= (count - d) / radius;
      sum += term * factor;
      if (term * factor < 1e-30 * sum) break;
    }
    return sum * 1.01;
  }

  // Upper end of an octave, from the lowest to [1/4, 1/2].
  static constexpr double place(std::size_t j) { return 0x1p-1 / static_cast<double>(1 << (octaves - 1 - j)); }

  double speed(double t) const { return t <= 0.0 ? 0.0 : exponential(-0.25 * k_ / (t * (1.0 - t))); }
  double integral_to(double t) const {
    std::size_t j = 0;
    while (j + 1 < octaves && t > place(j)) ++j;
    return below_[j] + integral([&](double x) { return speed(x); }, 0.5 * place(j), t);
  }

  static constexpr std::size_t octaves = 12;

  double amplitude_, k_, whole_ = 0.0;
  std::array<double, octaves> below_{};
};

}  // namespace stiction::sim::cam
