#include "sim/cam/shaping/two_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/normal_equations.hpp"

namespace stiction::sim::cam {
namespace {

using Complex = std::complex<double>;
constexpr double whole_turn = 2.0 * std::numbers::pi;

// e^(-s t) (a cos w t + b sin w t), twice, and a constant: (s, w, a, b), (s, w, a, b), c.
constexpr std::size_t of_both = 9;
using Both = Vector<of_both>;

double value_at(const Both& m, double t) {
  double sum = m[8];
  for (const std::size_t k : {0u, 4u})
    sum += std::exp(-m[k] * t) * (m[k + 2] * std::cos(m[k + 1] * t) + m[k + 3] * std::sin(m[k + 1] * t));
  return sum;
}

Both slopes(const Both& m, double t, bool hold) {
  Both row{};
  for (const std::size_t k : {0u, 4u}) {
    const double e = std::exp(-m[k] * t), co = std::cos(m[k + 1] * t), si = std::sin(m[k + 1] * t);
    const bool held = hold && k == 0;
    row[k] = held ? 0.0 : -t * e * (m[k + 2] * co + m[k + 3] * si);
    row[k + 1] = held ? 0.0 : t * e * (m[k + 3] * co - m[k + 2] * si);
    row[k + 2] = e * co;
    row[k + 3] = e * si;
  }
  row[8] = 1.0;
  return row;
}

double squares(const DwellRecord& record, const Both& both) {
  double sum = 0.0;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    const double off = record.position[k] - value_at(both, record.time[k]);
    sum += off * off;
  }
  return sum;
}

// The best amplitudes and constant for both poles.
Both with_best_amplitudes(const DwellRecord& record, const Mode& first, const Mode& second) {
  Normal<5> normal;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    const double t = record.time[k];
    const Complex a = std::exp(first.pole * t), b = std::exp(second.pole * t);
    normal.add({a.real(), a.imag(), b.real(), b.imag(), 1.0}, record.position[k]);
  }
  const auto f = normal.solve();
  return {-first.pole.real(), first.pole.imag(), f[0], f[1], -second.pole.real(), second.pole.imag(), f[2], f[3], f[4]};
}

// What the best amplitude of one mode and a constant leave.
double squares_alone(const DwellRecord& record, const Mode& mode) {
  Normal<3> normal;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    const Complex a = std::exp(mode.pole * record.time[k]);
    normal.add({a.real(), a.imag(), 1.0}, record.position[k]);
  }
  const auto f = normal.solve();
  return squares(record, {-mode.pole.real(), mode.pole.imag(), f[0], f[1], 0.0, 0.0, 0.0, 0.0, f[2]});
}

// By steps of Gauss and Newton, halved where they make it worse.
Both improved(const DwellRecord& record, Both best, bool hold) {
  constexpr int most_iterations = 30;
  constexpr double largest_damping = 0.2;
  double least = squares(record, best);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Normal<of_both> normal;
    for (std::size_t k = 0; k < record.time.size(); ++k)
      normal.add(slopes(best, record.time[k], hold), record.position[k] - value_at(best, record.time[k]));
    const auto step = normal.solve();
    Both next{};
    double sum = std::numeric_limits<double>::infinity(), share = 1.0;
    for (int halving = 0; halving < 8 && !(sum <= least); ++halving, share *= 0.5) {
      for (std::size_t i = 0; i < of_both; ++i) next[i] = best[i] + share * step[i];
      for (const std::size_t k : {0u, 4u})
        if (!(hold && k == 0)) next[k] = std::clamp(next[k], 0.0, largest_damping * std::fabs(next[k + 1]));
      sum = squares(record, next);
    }
    if (!(sum <= least)) break;
    const double gain = least - sum;
    best = next;
    least = sum;
    if (gain <= 1e-12 * least) break;
  }
  return best;
}

// Four equations for four amplitudes, by elimination with the largest pivot of a column.
std::array<double, 4> solved(std::array<std::array<double, 5>, 4> rows) {
  for (std::size_t k = 0; k < 4; ++k) {
    const auto largest =
        std::max_element(rows.begin() + static_cast<std::ptrdiff_t>(k), rows.end(),
                         [&](const auto& a, const auto& b) { return std::fabs(a[k]) < std::fabs(b[k]); });
    std::iter_swap(rows.begin() + static_cast<std::ptrdiff_t>(k), largest);
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == k) continue;
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j < 5; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  return {rows[0][4] / rows[0][0], rows[1][4] / rows[1][1], rows[2][4] / rows[2][2], rows[3][4] / rows[3][3]};
}

// The second pair's places, in periods of its own mode: a period is the length that asks for the least acceleration.
const std::vector<PulsePlaces>& second_places() {
  static const std::vector<PulsePlaces> all = [] {
    std::vector<PulsePlaces> places;
    for (const double length : {1.0, 0.75, 1.25})
      for (const double apart : {0.25, 0.5, 0.75})
        for (const double before : {0.0, 0.5, 1.0, 2.0}) places.push_back({length, apart, before});
    return places;
  }();
  return all;
}

// Both pulses of a pair with no amplitude yet, by a `mode` of that period.
PulsePair empty_pair(const ShapingTask& task, const Mode& mode, const PulsePlaces& places) {
  const double period = mode.period() * task.master_speed, length = places.length * period;
  const double second = task.end() - places.before * period - length, first = second - places.apart * period;
  return {{first, 0.0}, {second, 0.0}, length};
}

// What both pulses of a pair make of both modes, for an amplitude of one each that the own rise is less.
using Made = std::array<std::array<Complex, 2>, 2>;
Made made_by(const ShapingTask& task, const std::array<Mode, 2>& modes, const PulsePair& pair) {
  Made made;
  const Curve own = own_rise(task, task.stroke);
  for (std::size_t m = 0; m < 2; ++m) {
    const Complex of_own = lift_transform(task, own, modes[m]) / task.stroke;
    for (std::size_t p = 0; p < 2; ++p) {
      const double position = (p == 0 ? pair.first : pair.second).position;
      made[p][m] = lift_transform(task, law_curve("polynomial_3_4_5", position, pair.length, 1.0), modes[m]) - of_own;
    }
  }
  return made;
}

FourPulses with_amplitudes(FourPulses pulses, const std::array<Complex, 2>& residuals,
                           const std::array<Made, 2>& made) {
  std::array<std::array<double, 5>, 4> rows{};
  for (std::size_t m = 0; m < 2; ++m) {
    for (std::size_t p = 0; p < 4; ++p) {
      rows[2 * m][p] = made[p / 2][p % 2][m].real();
      rows[2 * m + 1][p] = made[p / 2][p % 2][m].imag();
    }
    rows[2 * m][4] = -residuals[m].real();
    rows[2 * m + 1][4] = -residuals[m].imag();
  }
  const auto amplitudes = solved(rows);
  for (std::size_t p = 0; p < 4; ++p)
    (p % 2 == 0 ? pulses[p / 2].first : pulses[p / 2].second).amplitude = amplitudes[p];
  return pulses;
}

}  // namespace

std::optional<TwoModeFit> fit_two_modes(const DwellRecord& whole, const Mode& first, double least, bool hold) {
  const DwellRecord record = thinned(whole);
  if (record.time.size() < 4 * of_both) return std::nullopt;
  const auto n = static_cast<double>(record.time.size());
  const double length = record.time.back() - record.time.front(), step = length / (n - 1.0);
  const double w = first.pole.imag(), apart = whole_turn / length;
  // Of one mode alone; the second one has to explain most of what that leaves.
  const double alone = squares_alone(record, first);
  Both best{};
  double smallest = std::numeric_limits<double>::infinity();
  // Up to four samples in a period; in steps of a tenth of what the record resolves.
  const double highest = std::min(8.0 * w, 0.25 * whole_turn / step);
  for (double other = 0.65 * w; other < highest; other += 0.1 * apart) {
    if (std::fabs(other - w) < 0.05 * apart) continue;
    const Both trial = with_best_amplitudes(record, first, {{-0.01 * other, other}});
    if (const double sum = squares(record, trial); sum < smallest) smallest = sum, best = trial;
  }
  if (smallest == std::numeric_limits<double>::infinity()) return std::nullopt;
  best = improved(record, best, hold);
  const double left = squares(record, best);
  std::vector<Both> rows;
  std::vector<double> deviations;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    rows.push_back(slopes(best, record.time[k], hold));
    deviations.push_back(record.position[k] - value_at(best, record.time[k]));
  }
  const auto quarter = static_cast<std::size_t>(std::max(1.0, 0.25 * whole_turn / best[5] / step));
  const auto variance = variances(rows, deviations, quarter);
  TwoModeFit found;
  for (std::size_t m = 0; m < 2; ++m) {
    const std::size_t k = 4 * m;
    DwellFit& fit = found.modes[m];
    fit.mode.pole = {-best[k], best[k + 1]};
    fit.residual = {0.5 * best[k + 2], -0.5 * best[k + 3]};
    fit.offset = best[8];
    fit.scatter = std::sqrt(left / (n - static_cast<double>(of_both)));
    fit.frequency_error = std::sqrt(variance[k + 1]);
    fit.damping_error = std::sqrt(variance[k]) / best[k + 1];
  }
  const auto& [one, two] = found.modes;
  const double at_begin = two.peak_to_peak() * std::exp(-best[4] * record.time.front());
  const double error = 2.0 * std::sqrt(variance[6] + variance[7]);
  constexpr double sure = 5.0, explained = 0.6, nearly_all = 0.2, same_size = 0.2;
  if (at_begin < least || two.peak_to_peak() < sure * error || left > explained * alone) return std::nullopt;
  const double between = std::fabs(two.mode.pole.imag() - one.mode.pole.imag());
  if (between < apart) {
    // A vibration whose frequency goes with its size looks like two: only where both are of one size, and leave almost
    // nothing, they are two.
    if (left > nearly_all * alone || std::abs(two.residual) < same_size * std::abs(one.residual) || hold)
      return std::nullopt;
    throw CamError(fmt::format(
        "found two modes at about {:.2f} and {:.2f} Hz, which a dwell of {:.0f} ms does not tell apart; expected them "
        "{:.1f} Hz apart or more, or a longer dwell",
        std::min(one.mode.frequency(), two.mode.frequency()) / whole_turn,
        std::max(one.mode.frequency(), two.mode.frequency()) / whole_turn, 1e3 * length, 1.0 / length));
  }
  return two.mode.pole.imag() > one.mode.pole.imag() ? std::optional(found) : std::nullopt;
}

TwoResiduals residuals_with_modes(const DwellRecord& record, const std::array<Mode, 2>& modes) {
  const Both both = with_best_amplitudes(thinned(record), modes[0], modes[1]);
  return {{Complex{0.5 * both[2], -0.5 * both[3]}, Complex{0.5 * both[6], -0.5 * both[7]}}, both[8]};
}

Complex lift_transform(const ShapingTask& task, const Curve& lift, const Mode& mode) {
  Complex sum = 0.0;
  // Simpson's rule, 64 intervals in a period and four at least in a piece.
  const double finest = mode.period() * task.master_speed / 64.0;
  for (const Piece& piece : lift.pieces()) {
    const int intervals = 2 * static_cast<int>(std::max(2.0, std::ceil(0.5 * piece.length() / finest)));
    const double h = piece.length() / intervals;
    for (int k = 0; k <= intervals; ++k) {
      const double x = piece.begin + h * k, weight = k == 0 || k == intervals ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      sum += weight * h / 3.0 * piece.derivative(x, 1) * std::exp(mode.pole * ((task.end() - x) / task.master_speed));
    }
  }
  return sum;
}

FourPulses four_pulses(const ShapingTask& task, const std::array<Mode, 2>& modes,
                       const std::array<Complex, 2>& residuals, const FourPlaces& places) {
  return four_pulses_at(task, modes, residuals,
                        {empty_pair(task, modes[0], places[0]), empty_pair(task, modes[1], places[1])});
}

FourPulses four_pulses_at(const ShapingTask& task, const std::array<Mode, 2>& modes,
                          const std::array<Complex, 2>& residuals, FourPulses pulses) {
  return with_amplitudes(pulses, residuals, {made_by(task, modes, pulses[0]), made_by(task, modes, pulses[1])});
}

std::vector<FourPlaces> four_places(const ShapingTask& task, const std::array<Mode, 2>& modes,
                                    const std::array<Complex, 2>& residuals) {
  struct Candidate {
    FourPlaces places;
    double acceleration;
  };
  std::vector<Candidate> all;
  const auto fits = [&](const PulsePlaces& places, const Mode& mode) {
    return places.room() * mode.period() * task.master_speed <= task.length();
  };
  const Curve own = own_rise(task, 1.0);
  struct Placed {
    PulsePlaces places;
    PulsePair pair;
    Made made;
  };
  std::vector<Placed> seconds;
  for (const auto& places : second_places()) {
    if (!fits(places, modes[1])) continue;
    const auto pair = empty_pair(task, modes[1], places);
    seconds.push_back({places, pair, made_by(task, modes, pair)});
  }
  for (const auto& first : pulse_places()) {
    if (!fits(first, modes[0])) continue;
    const auto pair = empty_pair(task, modes[0], first);
    const auto made = made_by(task, modes, pair);
    for (const auto& [second, second_pair, made_second] : seconds) {
      const auto pulses = with_amplitudes({pair, second_pair}, residuals, {made, made_second});
      double stroke = task.stroke, largest = 0.0;
      std::vector<std::pair<Curve, double>> curves;
      for (const PulsePair& each : pulses)
        for (const Pulse& pulse : {each.first, each.second}) {
          stroke -= pulse.amplitude;
          curves.emplace_back(law_curve("polynomial_3_4_5", pulse.position, each.length, pulse.amplitude), each.length);
        }
      constexpr int samples = 120;
      for (int k = 0; k < samples; ++k) {
        const double x = task.begin + task.length() * (k + 0.5) / samples;
        double sum = stroke * own.derivative(x, 2);
        for (const auto& [curve, length] : curves)
          if (x > curve.begin() && x < curve.end()) sum += curve.derivative(x, 2);
        largest = std::max(largest, std::fabs(sum));
      }
      all.push_back({{first, second}, largest});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.acceleration < b.acceleration; });
  std::vector<FourPlaces> places;
  for (const Candidate& candidate : all) places.push_back(candidate.places);
  return places;
}

}  // namespace stiction::sim::cam
