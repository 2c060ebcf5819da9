#include "sim/cam/shaping/dwell_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/cam/shaping/normal_equations.hpp"

namespace stiction::sim::cam {
namespace {

// e^(-s t) (a cos w t + b sin w t) + c.
struct DampedSine {
  double s, w, a, b, c;

  double at(double t) const { return std::exp(-s * t) * (a * std::cos(w * t) + b * std::sin(w * t)) + c; }
};

double squares(const DwellRecord& record, const DampedSine& sine) {
  double sum = 0.0;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    const double off = record.position[k] - sine.at(record.time[k]);
    sum += off * off;
  }
  return sum;
}

// The best amplitudes and constant for a decay `s` and a frequency `w`.
DampedSine with_best_amplitudes(const DwellRecord& record, double s, double w) {
  Normal<3> normal;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    const double t = record.time[k], e = std::exp(-s * t);
    normal.add({e * std::cos(w * t), e * std::sin(w * t), 1.0}, record.position[k]);
  }
  const auto found = normal.solve();
  return {s, w, found[0], found[1], found[2]};
}

// Of a vibration that lasts for a dwell; noise alone is fitted best by one that is over at once.
constexpr double largest_damping = 0.2;

Vector<5> slopes(const DampedSine& m, double t) {
  const double e = std::exp(-m.s * t), co = std::cos(m.w * t), si = std::sin(m.w * t);
  return {-t * e * (m.a * co + m.b * si), t * e * (m.b * co - m.a * si), e * co, e * si, 1.0};
}

// By steps of Gauss and Newton from `best`, with a decay of `slowest` at least.
DampedSine improved(const DwellRecord& record, DampedSine best, double slowest) {
  double least = squares(record, best);
  constexpr int most_iterations = 30;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Normal<5> normal;
    for (std::size_t k = 0; k < record.time.size(); ++k)
      normal.add(slopes(best, record.time[k]), record.position[k] - best.at(record.time[k]));
    const auto step = normal.solve();
    double share = 1.0;
    DampedSine next{};
    double sum = 0.0;
    // Half of the step where the whole one makes it worse.
    for (int halving = 0; halving < 8; ++halving, share *= 0.5) {
      next = {std::clamp(best.s + share * step[0], slowest, largest_damping * best.w), best.w + share * step[1],
              best.a + share * step[2], best.b + share * step[3], best.c + share * step[4]};
      sum = squares(record, next);
      if (sum <= least) break;
    }
    if (sum > least) break;
    const double gain = least - sum;
    best = next;
    least = sum;
    if (gain <= 1e-12 * least) break;
  }
  return best;
}

// Parameters' variances; an encoder's step and the next belong together for up to a quarter of a period.
Vector<5> variances_of(const DwellRecord& record, const DampedSine& sine) {
  std::vector<Vector<5>> rows;
  std::vector<double> deviations;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    rows.push_back(slopes(sine, record.time[k]));
    deviations.push_back(record.position[k] - sine.at(record.time[k]));
  }
  const double step = (record.time.back() - record.time.front()) / (static_cast<double>(record.time.size()) - 1.0);
  const auto quarter = static_cast<std::size_t>(0.5 * std::numbers::pi / sine.w / step);
  return variances(rows, deviations, std::max<std::size_t>(1, quarter));
}

}  // namespace

DwellRecord thinned(const DwellRecord& record) {
  constexpr std::size_t most = 600;
  const std::size_t block = std::max<std::size_t>(1, record.time.size() / most);
  DwellRecord thin;
  for (std::size_t k = 0; k + block <= record.time.size(); k += block) {
    double time = 0.0, position = 0.0;
    for (std::size_t i = k; i < k + block; ++i) time += record.time[i], position += record.position[i];
    thin.time.push_back(time / static_cast<double>(block));
    thin.position.push_back(position / static_cast<double>(block));
  }
  return thin;
}

std::optional<DwellFit> fit_dwell(const DwellRecord& whole, double guess) {
  const DwellRecord record = thinned(whole);
  const auto n = static_cast<double>(record.time.size());
  if (record.time.size() < 12 || record.time.back() - record.time.front() < 2.0 * std::numbers::pi / guess)
    return std::nullopt;
  DampedSine best{};
  double smallest = std::numeric_limits<double>::infinity();
  constexpr int steps = 70;
  for (int k = 0; k <= steps; ++k) {
    const double w = guess * (0.65 + 0.7 * k / steps);
    const auto sine = with_best_amplitudes(record, 0.015 * w, w);
    if (const double sum = squares(record, sine); sum < smallest) smallest = sum, best = sine;
  }
  best = improved(record, best, 0.0);
  const double least = squares(record, best);
  DwellFit fit;
  fit.mode.pole = {-best.s, best.w};
  fit.residual = {0.5 * best.a, -0.5 * best.b};
  fit.offset = best.c;
  fit.scatter = std::sqrt(least / (n - 5.0));
  const auto found = variances_of(record, best);
  fit.frequency_error = std::sqrt(found[1]);
  fit.damping_error = std::sqrt(found[0]) / best.w;
  fit.residual_error = 0.5 * std::sqrt(found[2] + found[3]);
  if (std::fabs(best.w - guess) > 0.35 * guess ||
      2.0 * std::abs(fit.residual) * std::exp(-best.s * record.time.front()) < fit.scatter)
    return std::nullopt;
  return fit;
}

double growth_of(const DwellRecord& whole, const DwellFit& fit) {
  const DwellRecord record = thinned(whole);
  const double w = fit.mode.pole.imag();
  const auto sine = improved(record, with_best_amplitudes(record, -fit.mode.pole.real(), w), -largest_damping * w);
  // So far off that it is not the fit's.
  constexpr double sure = 5.0;
  if (sine.s > -sure * std::sqrt(variances_of(record, sine)[0])) return 0.0;
  const double begin = record.time.front(), end = record.time.back();
  return 2.0 * std::hypot(sine.a, sine.b) * (std::exp(-sine.s * end) - std::exp(-sine.s * begin));
}

std::complex<double> residual_with_mode(const DwellRecord& record, const Mode& mode, double* offset) {
  const auto sine = with_best_amplitudes(thinned(record), -mode.pole.real(), mode.pole.imag());
  if (offset != nullptr) *offset = sine.c;
  return {0.5 * sine.a, -0.5 * sine.b};
}

ElasticDrive drive_with_mode(const ElasticDrive& drive, const Mode& mode) {
  ElasticDrive changed = drive;
  // Frequency and damping of the mode go with stiffness and damping of the shaft, almost in proportion.
  constexpr int iterations = 12;
  for (int k = 0; k < iterations; ++k) {
    const Mode now = load_mode(changed);
    const double ratio = mode.frequency() / now.frequency();
    changed.shaft_stiffness *= ratio * ratio;
    const double critical = 2.0 * std::sqrt(changed.shaft_stiffness * changed.load_inertia);
    changed.shaft_damping =
        std::max(0.0, changed.shaft_damping + critical * (mode.damping_ratio() - now.damping_ratio()));
  }
  return changed;
}

}  // namespace stiction::sim::cam
