#include "tests/blind/truth/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace stiction::blind {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double shortest_ramp = 0.04;  // s

// A move's ramps and its cruise between them.
struct Timing {
  double speed, ramp, cruise;
};
Timing timing_of(const Piece& p) {
  const double way = std::abs(p.length);
  double speed = std::min(p.speed, std::sqrt(0.5 * way * p.acceleration));
  double ramp = std::max(2.0 * speed / p.acceleration, shortest_ramp);
  if (speed * ramp > way) speed = way / ramp;
  return {speed, ramp, way / speed - ramp};
}

// From rest to `speed` with a sin^2 acceleration; s seconds into it, unsigned.
sim::AxisSetPoint ramp_at(double speed, double ramp, double s) {
  const double u = s / ramp;
  return {speed * ramp * (0.5 * u * u + (std::cos(2.0 * pi * u) - 1.0) / (4.0 * pi * pi)),
          speed * (u - std::sin(2.0 * pi * u) / (2.0 * pi)), speed / ramp * (1.0 - std::cos(2.0 * pi * u))};
}

sim::AxisSetPoint move_at(const Piece& p, double s) {
  const auto [speed, ramp, cruise] = timing_of(p);
  const double sign = p.length < 0.0 ? -1.0 : 1.0;
  const double whole = 2.0 * ramp + cruise;
  sim::AxisSetPoint m;
  if (s < ramp) {
    m = ramp_at(speed, ramp, s);
  } else if (s <= ramp + cruise) {
    m = {speed * (s - 0.5 * ramp), speed, 0.0};
  } else {
    const auto back = ramp_at(speed, ramp, std::max(0.0, whole - s));
    m = {std::abs(p.length) - back.position, back.velocity, -back.acceleration};
  }
  return {sign * m.position, sign * m.velocity, sign * m.acceleration};
}

// The phase runs up to its rate over one cycle and down again, as a ramp_at does: two cycles take half of the way.
sim::AxisSetPoint swing_at(const Piece& p, double s) {
  const double rate = 2.0 * pi * p.frequency, ramp = 2.0 / p.frequency;
  const double cruise = (p.cycles - 2) / p.frequency, whole = 2.0 * ramp + cruise;
  sim::AxisSetPoint phase;
  if (s < ramp) {
    phase = ramp_at(rate, ramp, s);
  } else if (s <= ramp + cruise) {
    phase = {rate * (s - 0.5 * ramp), rate, 0.0};
  } else {
    const auto back = ramp_at(rate, ramp, std::max(0.0, whole - s));
    phase = {rate * (ramp + cruise) - back.position, back.velocity, -back.acceleration};
  }
  const double half = 0.5 * p.length, c = std::cos(phase.position), sn = std::sin(phase.position);
  return {half * (1.0 - c), half * sn * phase.velocity,
          half * (c * phase.velocity * phase.velocity + sn * phase.acceleration)};
}

double duration_of(const Piece& p) {
  switch (p.kind) {
    case Piece::Kind::rest:
      return p.rest;
    case Piece::Kind::move: {
      const auto t = timing_of(p);
      return 2.0 * t.ramp + t.cruise;
    }
    case Piece::Kind::swing:
      return (p.cycles + 2) / p.frequency;
  }
  return 0.0;
}

Piece rest(double seconds) { return {.rest = seconds}; }
Piece move(double length, double speed, double acceleration) {
  return {.kind = Piece::Kind::move, .length = length, .speed = speed, .acceleration = acceleration};
}
Piece swing(double length, double frequency, int cycles) {
  return {.kind = Piece::Kind::swing, .length = length, .frequency = frequency, .cycles = cycles};
}

// There and back at each speed, cruising for about `seconds`.
std::vector<Piece> constant_speeds(Random& random, const std::vector<double>& speeds, double seconds) {
  std::vector<Piece> pieces{rest(0.1)};
  for (const double each : speeds) {
    const double v = each * uniform(random, 0.8, 1.25);
    const double way = std::clamp(v * (seconds + v), 2e-4, 0.36);
    const double acceleration = uniform(random, 2.0, 5.0);
    for (const double sign : {1.0, -1.0}) {
      pieces.push_back(move(sign * way, v, acceleration));
      pieces.push_back(rest(0.05));
    }
  }
  return pieces;
}

std::vector<Piece> circles(Random& random, double radius, const std::vector<double>& feeds) {
  std::vector<Piece> pieces{rest(0.1)};
  for (const double feed : feeds) {
    const double v = feed * uniform(random, 0.85, 1.15);
    pieces.push_back(swing(2.0 * radius, v / (2.0 * pi * radius), 2));
    pieces.push_back(rest(0.05));
  }
  return pieces;
}

std::vector<Piece> positioning(Random& random, int count, double low, double high) {
  std::vector<Piece> pieces{rest(0.1)};
  double x = 0.0;
  for (int k = 0; k < count; ++k) {
    const double target = uniform(random, low, high);
    pieces.push_back(move(target - x, log_uniform(random, 0.05, 0.6), uniform(random, 3.0, 8.0)));
    pieces.push_back(rest(uniform(random, 0.03, 0.12)));
    x = target;
  }
  return pieces;
}

std::vector<Piece> small_reversals(Random& random, const std::vector<double>& amplitudes) {
  std::vector<Piece> pieces{rest(0.1)};
  for (const double each : amplitudes) {
    pieces.push_back(swing(each * uniform(random, 0.8, 1.25), uniform(random, 2.5, 5.0), 4));
    pieces.push_back(rest(0.05));
  }
  return pieces;
}

std::vector<Piece> joined(std::vector<Piece> a, const std::vector<Piece>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

Trajectory::Trajectory(std::string name, double start, std::vector<Piece> pieces)
    : name_(std::move(name)), end_(start), start_(start) {
  for (const auto& piece : pieces) {
    const double length = duration_of(piece);
    placed_.push_back({piece, duration_, length, end_});
    duration_ += length;
    if (piece.kind == Piece::Kind::move) end_ += piece.length;
  }
}

sim::AxisSetPoint Trajectory::at(double t) const {
  if (t <= 0.0) return {start_};
  if (t >= duration_) return {end_};
  const auto next = std::upper_bound(placed_.begin(), placed_.end(), t,
                                     [](double time, const Placed& placed) { return time < placed.begin; });
  const auto& now = *std::prev(next);
  sim::AxisSetPoint set;
  if (now.piece.kind == Piece::Kind::move) set = move_at(now.piece, t - now.begin);
  if (now.piece.kind == Piece::Kind::swing) set = swing_at(now.piece, t - now.begin);
  set.position += now.from;
  return set;
}

std::vector<Trajectory> training_trajectories(Random& random) {
  const double radius = uniform(random, 0.03, 0.07);
  return {
      {"constant-speeds", uniform(random, -0.2, -0.1),
       constant_speeds(random, {0.001, 0.004, 0.012, 0.04, 0.1, 0.2, 0.35}, 0.35)},
      {"circle-and-positioning", uniform(random, -0.1, 0.0),
       joined(circles(random, radius, {0.18, 0.35}), positioning(random, 5, -0.1, 0.2))},
      {"small-reversals", uniform(random, -0.05, 0.05),
       joined(small_reversals(random, {5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6}), positioning(random, 3, -0.1, 0.1))},
  };
}

std::vector<Trajectory> holdout_trajectories(Random& random) {
  const double radius = uniform(random, 0.02, 0.04);
  return {
      {"other-circles", uniform(random, -0.15, 0.0),
       joined(circles(random, radius, {0.12, 0.25}), constant_speeds(random, {0.0025, 0.02, 0.15}, 0.5))},
      {"other-positioning", uniform(random, -0.1, 0.1),
       joined(positioning(random, 6, -0.12, 0.12), small_reversals(random, {8e-6, 35e-6, 150e-6}))},
  };
}

}  // namespace stiction::blind
