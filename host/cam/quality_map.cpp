#include "host/cam/quality_map.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "sim/cam/shaping/lift.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;
using sim::cam::ShapingTask;

constexpr std::array shares{0.05, 0.2, 0.5, 1.0};

Complex of_rise(const ShapingTask& task) { return residual_of(task, own_rise(task, task.stroke), task.end()); }

// Of a pulse with the amplitude one, which the own rise is less.
Complex of_pulse(const ShapingTask& task, double position, double length) {
  sim::cam::Lift lift;
  lift.add(sim::cam::law_curve("polynomial_3_4_5", position, length, 1.0));
  return residual_of(task, lift.sampled(task.begin, task.end()), task.end()) - of_rise(task) / task.stroke;
}

// What each cycle leaves goes on in the next ones: c + c^2 + .. of it, with c the mode's turn and decay over a cycle.
double grown_by_running(const ShapingTask& task, bool running) {
  if (!running) return 1.0;
  return 1.0 / std::abs(1.0 - std::exp(task.mode().pole * (task.motion.curve.length() / task.master_speed)));
}

}  // namespace

double quality_of_residual(const ShapingTask& task, double magnitude) {
  const double decay = -task.mode().pole.real();
  const double time = (std::min(task.dwell.end(), task.motion.curve.length()) - task.end()) / task.master_speed;
  const double lasting = decay * time > 1e-9 ? (1.0 - std::exp(-decay * time)) / decay : time;
  return 4.0 / std::numbers::pi * magnitude * lasting * task.master_speed;
}

std::vector<LevelLine> map_of_one_pulse(const ShapingTask& task, double length, double periods, bool running) {
  const Complex own = of_rise(task);
  const double untuned = quality_of_residual(task, grown_by_running(task, running) * std::abs(own));
  const double last = task.end() - length, first = std::max(task.begin, last - periods * task.period_length());
  constexpr int columns = 400;  // a twentieth is kept over a sixtieth of a period
  std::vector<std::pair<double, Complex>> pulses;
  for (int k = 0; k <= columns; ++k) {
    const double position = first + (last - first) * k / columns;
    pulses.emplace_back(position, of_pulse(task, position, length));
  }
  std::vector<LevelLine> lines;
  for (const double share : shares) {
    // |own + a pulse| = share |own|: two amplitudes a at a place, or none.
    LevelLine above, below;
    const auto close = [&] {
      if (!above.points.empty()) {
        above.points.insert(above.points.end(), below.points.rbegin(), below.points.rend());
        above.points.push_back(above.points.front());
        above.level = share * untuned;
        lines.push_back(above);
      }
      above = below = {};
    };
    for (const auto& [position, pulse] : pulses) {
      const double square = std::norm(pulse), along = -(std::conj(pulse) * own).real() / square;
      const double root = along * along - (1.0 - share * share) * std::norm(own) / square;
      if (root < 0.0) {
        close();
        continue;
      }
      above.points.push_back({position, along + std::sqrt(root)});
      below.points.push_back({position, along - std::sqrt(root)});
    }
    close();
  }
  return lines;
}

std::vector<LevelLine> map_of_two_pulses(const ShapingTask& task, const sim::cam::PulsePair& where, bool running) {
  const Complex own = of_rise(task);
  const double untuned = quality_of_residual(task, grown_by_running(task, running) * std::abs(own));
  std::vector<LevelLine> lines;
  constexpr int places = 72;
  for (const double share : shares) {
    LevelLine line{share * untuned, {}};
    for (int k = 0; k <= places; ++k) {
      const Complex left = std::polar(share * std::abs(own), 2.0 * std::numbers::pi * k / places);
      const auto pair = pulse_pair_at(task, own - left, where);
      line.points.push_back({pair.first.amplitude, pair.second.amplitude});
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace stiction::host
