#include "sim/cam/shaping/pulses.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "sim/cam/shaping/lift.hpp"
#include "sim/number/complex.hpp"

namespace stiction::sim::cam {
namespace {

using Complex = std::complex<double>;

// The bump (1 - cos)/2.
Curve bump(double begin, double length, double amplitude) {
  Piece piece = polynomial_piece(begin, begin + length, {0.5 * amplitude});
  piece.rate = 1.0 / length;
  piece.waves = {{-0.5 * amplitude, 2.0 * std::numbers::pi, 0.5 * std::numbers::pi}};
  return Curve({piece});
}

Curve lift_of(const Lift& lift, const ShapingTask& task, double end) { return lift.sampled(task.begin, end); }

// Where the imaginary part of `ratio` crosses zero between `begin` and `end`, the crossing nearest to `begin`.
std::optional<double> crossing(const std::function<Complex(double)>& ratio, double begin, double end) {
  constexpr int samples = 96;
  double from = begin, at_from = ratio(from).imag();
  for (int k = 1; k <= samples; ++k) {
    const double to = begin + (end - begin) * k / samples, at_to = ratio(to).imag();
    if ((at_from > 0.0) == (at_to > 0.0)) {
      from = to, at_from = at_to;
      continue;
    }
    double low = from, high = to;
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      ((ratio(middle).imag() > 0.0) == (at_from > 0.0) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  return std::nullopt;
}

// Peak to peak in what the pulse leaves of the dwell, once the drive has followed it.
double left_behind(const ShapingTask& task, const Pulse& pulse, double length) {
  const Motion motion = compose(with_lift(task.motion.cam, with_dwell_pulse(task, pulse, length)));
  const double begin = pulse.position + length + drive_lag(task);
  return dwell_figures(transfer_response(task.drive, motion, {.master_speed = task.master_speed}), motion,
                       {begin, std::min(task.dwell.end(), motion.curve.length()) - begin})
      .peak_to_peak;
}

// The load's mode alone is cancelled by `pulse`; the drive's own, which the end of the bump excites, is made smallest
// by steps of both parameters that become smaller where none helps.
Pulse with_least_left(const ShapingTask& task, Pulse pulse, double length) {
  double least = left_behind(task, pulse, length), place = 0.01 * length, share = 0.02;
  constexpr int most_trials = 60;
  for (int trial = 0; trial < most_trials && share > 1e-4;) {
    bool better = false;
    for (const auto& [by_place, by_share] : {std::pair{place, 0.0}, {-place, 0.0}, {0.0, share}, {0.0, -share}}) {
      const Pulse next{std::max(task.end(), pulse.position + by_place), pulse.amplitude * (1.0 + by_share)};
      const double left = left_behind(task, next, length);
      ++trial;
      if (left >= least) continue;
      least = left;
      pulse = next;
      better = true;
    }
    if (!better) place *= 0.5, share *= 0.5;
  }
  return pulse;
}

}  // namespace

Curve own_rise(const ShapingTask& task, double stroke) {
  std::vector<Piece> pieces;
  for (const Piece& piece : task.motion.curve.pieces())
    if (piece.begin >= task.begin - 1e-12 && piece.end <= task.end() + 1e-9) pieces.push_back(piece);
  const double gain = stroke / task.stroke;
  return Curve(std::move(pieces))
      .placed({.from = task.begin, .begin = task.begin, .gain = gain, .offset = task.start * (1.0 - gain)});
}

double drive_lag(const ShapingTask& task) {
  double slowest = 0.0;
  const Complex mode = task.mode().pole;
  for (const Complex& pole : transfer_function(task.drive).poles())
    if (magnitude(pole - mode) > 1e-9 * magnitude(mode) && magnitude(pole - std::conj(mode)) > 1e-9 * magnitude(mode))
      slowest = std::max(slowest, -1.0 / pole.real());
  return slowest * task.master_speed;
}

Curve with_pulse(const ShapingTask& task, const Pulse& pulse, std::string_view law, double length) {
  Lift lift;
  lift.add(own_rise(task, task.stroke - pulse.amplitude));
  lift.add(law_curve(law, pulse.position, length, pulse.amplitude));
  return lift_of(lift, task, task.end());
}

std::optional<Pulse> tuned_pulse(const ShapingTask& task, std::string_view law, double length) {
  if (length > task.length()) return std::nullopt;
  const Complex own = residual_of(task, own_rise(task, task.stroke), task.end()) / task.stroke;
  // Amplitude over stroke: own (1 - a) + pulse a = 0.
  const auto share = [&](double position) {
    Lift lift;
    lift.add(law_curve(law, position, length, 1.0));
    const Complex one = residual_of(task, lift_of(lift, task, task.end()), task.end());
    return quotient(own, own - one);
  };
  const auto position = crossing(share, task.end() - length, task.begin);
  if (!position) return std::nullopt;
  return Pulse{*position, share(*position).real() * task.stroke};
}

Curve with_dwell_pulse(const ShapingTask& task, const Pulse& pulse, double length) {
  Lift lift;
  lift.add(own_rise(task, task.stroke));
  lift.add(bump(pulse.position, length, pulse.amplitude));
  return lift_of(lift, task, pulse.position + length);
}

std::optional<Pulse> tuned_dwell_pulse(const ShapingTask& task, double length) {
  const double half = 0.5 * task.period_length();
  if (half + length > task.dwell.length) return std::nullopt;
  const double at = task.end() + half + length;
  const Complex own = residual_of(task, own_rise(task, task.stroke), at);
  const auto amplitude = [&](double position) {
    Lift lift;
    lift.add(bump(position, length, 1.0));
    return quotient(-own, residual_of(task, lift_of(lift, task, position + length), at));
  };
  const auto position = crossing(amplitude, task.end(), task.end() + half);
  if (!position) return std::nullopt;
  return with_least_left(task, {*position, amplitude(*position).real()}, length);
}

const std::vector<PulsePlaces>& pulse_places() {
  static const std::vector<PulsePlaces> all = [] {
    std::vector<PulsePlaces> places;
    for (const double length : {0.5, 0.75, 1.0})
      for (const double apart : {0.25, 0.375, 0.5})
        for (const double before : {0.0, 0.25, 0.5}) places.push_back({length, apart, before});
    return places;
  }();
  return all;
}

std::optional<PulsePair> pulse_pair(const ShapingTask& task, Complex residual, const PulsePlaces& places) {
  const double period = task.period_length(), length = places.length * period;
  if (places.room() * period > task.length()) return std::nullopt;
  const double second = task.end() - places.before * period - length, first = second - places.apart * period;
  return pulse_pair_at(task, residual, {{first, 0.0}, {second, 0.0}, length});
}

PulsePair pulse_pair_at(const ShapingTask& task, Complex residual, PulsePair where) {
  const Complex own = residual_of(task, own_rise(task, task.stroke), task.end()) / task.stroke;
  const auto one = [&](double position) {
    Lift lift;
    lift.add(law_curve("polynomial_3_4_5", position, where.length, 1.0));
    return residual_of(task, lift_of(lift, task, task.end()), task.end()) - own;
  };
  // residual + a u + b v = 0 in its two parts.
  const Complex u = one(where.first.position), v = one(where.second.position);
  const double determinant = u.real() * v.imag() - u.imag() * v.real();
  where.first.amplitude = (-residual.real() * v.imag() + residual.imag() * v.real()) / determinant;
  where.second.amplitude = (-residual.imag() * u.real() + residual.real() * u.imag()) / determinant;
  return where;
}

Curve with_pulses(const ShapingTask& task, const PulsePair& pulses) { return with_pulses(task, {&pulses, 1}); }

Curve with_pulses(const ShapingTask& task, std::span<const PulsePair> pairs) {
  Lift lift;
  double stroke = task.stroke;
  for (const PulsePair& pair : pairs) stroke -= pair.first.amplitude + pair.second.amplitude;
  lift.add(own_rise(task, stroke));
  for (const PulsePair& pair : pairs)
    for (const Pulse& pulse : {pair.first, pair.second})
      lift.add(law_curve("polynomial_3_4_5", pulse.position, pair.length, pulse.amplitude));
  return lift_of(lift, task, task.end());
}

}  // namespace stiction::sim::cam
