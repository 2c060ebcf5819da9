#include "firmware/stictiond/load_mode_fit.hpp"

#include <cmath>
#include <complex>

namespace stiction::drive {
namespace {

struct Fitted {
  double left = 0.0, vibration = 0.0;  // mean squares
};

// The best a Re z^n + b Im z^n + o.
Fitted fitted(std::span<const std::int32_t> deviations, double interval, machine::LoadMode mode, double frequency) {
  mode.frequency = frequency;
  const std::complex<double> turn = std::exp(mode.pole() * interval);
  std::complex<double> phasor = 1.0;
  double c = 0, s = 0, d = 0, cc = 0, cs = 0, ss = 0, dc = 0, ds = 0, dd = 0;
  for (const std::int32_t deviation : deviations) {
    const double x = deviation, re = phasor.real(), im = phasor.imag();
    c += re, s += im, d += x;
    cc += re * re, cs += re * im, ss += im * im;
    dc += x * re, ds += x * im, dd += x * x;
    phasor *= turn;
  }
  const auto n = static_cast<double>(deviations.size());
  for (double* sum : {&c, &s, &d, &cc, &cs, &ss, &dc, &ds, &dd}) *sum /= n;
  cc -= c * c, cs -= c * s, ss -= s * s, dc -= d * c, ds -= d * s, dd -= d * d;
  const double determinant = cc * ss - cs * cs;
  const double vibration = (dc * (dc * ss - ds * cs) + ds * (ds * cc - dc * cs)) / determinant;
  return {dd - vibration, vibration};
}

}  // namespace

std::optional<double> load_frequency(std::span<const std::int32_t> deviations, double interval,
                                     const machine::LoadMode& mode) {
  if (deviations.size() < 16) return {};
  constexpr int steps = 40;
  const double low = 0.8 * mode.frequency, step = 0.4 * mode.frequency / steps;
  const auto left = [&](double frequency) { return fitted(deviations, interval, mode, frequency).left; };
  int best = 0;
  double least = left(low);
  for (int k = 1; k <= steps; ++k)
    if (const double now = left(low + k * step); now < least) least = now, best = k;
  if (best == 0 || best == steps) return {};
  // Golden section.
  constexpr double share = 0.6180339887498949;
  double from = low + (best - 1) * step, to = low + (best + 1) * step;
  double x = to - share * (to - from), y = from + share * (to - from), at_x = left(x), at_y = left(y);
  for (int k = 0; k < 30; ++k) {
    if (at_x < at_y) {
      to = y, y = x, at_y = at_x;
      x = to - share * (to - from), at_x = left(x);
    } else {
      from = x, x = y, at_x = at_y;
      y = from + share * (to - from), at_y = left(y);
    }
  }
  const double found = 0.5 * (from + to);
  const auto fit = fitted(deviations, interval, mode, found);
  if (64.0 * fit.left > fit.vibration) return {};
  return found;
}

}  // namespace stiction::drive
