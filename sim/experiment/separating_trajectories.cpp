#include "sim/experiment/separating_trajectories.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "sim/experiment/move_sequence.hpp"

namespace stiction::sim {
namespace {

constexpr double settled = 0.3;  // s, before the first motion and behind the last

Dynamics full(const MotionRange& r) { return {r.acceleration, r.jerk}; }
// A share of the highest acceleration, reached in the same time.
Dynamics up_to(const MotionRange& r, double share) {
  const double acceleration = share * r.highest_acceleration;
  return {acceleration, acceleration * r.jerk / r.acceleration};
}
double stroke(const MotionRange& r) { return r.high - r.low; }

Trajectory finished(MoveSequence moves) {
  moves.rest(settled);
  return {"", moves.duration(), [moves](double t) { return moves.at(t); }};
}
MoveSequence begun(const MotionRange& r) {
  MoveSequence moves(r.low);
  moves.rest(settled);
  return moves;
}

// There and back with the speed held for `cruise` s, and over at least `shortest` m, where the stroke allows it.
void both_ways(MoveSequence& moves, const MotionRange& r, double speed, double cruise, double shortest) {
  const double held = std::max(cruise, shortest / speed);
  const double v = speed_within(stroke(r), speed, held, full(r));
  for (const double sign : {1.0, -1.0}) {
    moves.pass(sign * v, held, full(r));
    moves.rest(0.1);
  }
}

void over_the_stroke(MoveSequence& moves, const MotionRange& r, double seconds, const Dynamics& dynamics) {
  const double speed = seconds > 0.0 ? std::min(stroke(r) / seconds, r.speed) : r.speed;
  for (const double sign : {1.0, -1.0}) {
    moves.move(sign * stroke(r), speed, dynamics);
    moves.rest(0.1);
  }
}

Trajectory constant_speeds(const MotionRange& r) {
  auto moves = begun(r);
  const double fastest = speed_within(stroke(r), r.speed, 0.3, full(r));
  for (const double share : {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0})
    both_ways(moves, r, share * fastest, 0.3, 0.6e-3);
  return finished(moves);
}

Trajectory crawls(const MotionRange& r) {
  auto moves = begun(r);
  for (const double speed : {0.2e-3, 0.5e-3, 1e-3, 2e-3, 4e-3, 7e-3, 10e-3, 20e-3, 40e-3})
    both_ways(moves, r, std::min(speed, r.speed), 0.5, 0.6e-3);
  return finished(moves);
}

Trajectory reversals(const MotionRange& r) {
  std::vector<double> amplitudes;
  for (const double a : {5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 1e-3, 2e-3})
    amplitudes.push_back(std::min(a, 0.5 * stroke(r)));
  const auto path = small_reversals(amplitudes, 1.0);
  return {"", path.duration + 2.0 * settled, [path, low = r.low](double t) {
            if (t < settled || t > settled + path.duration) return AxisSetPoint{low};
            auto point = path.at(t - settled);
            point.position += low;
            return point;
          }};
}

Trajectory accelerations(const MotionRange& r) {
  auto moves = begun(r);
  // Short enough that it speeds up or down nearly all the time.
  const double way = std::min(stroke(r), 0.1);
  for (const double share : {0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0})
    for (int turn = 0; turn < 3; ++turn)
      for (const double sign : {1.0, -1.0}) {
        moves.move(sign * way, r.speed, up_to(r, share));
        moves.rest(0.05);
      }
  return finished(moves);
}

Trajectory sweep(const MotionRange& r) {
  auto moves = begun(r);
  over_the_stroke(moves, r, 8.0, full(r));
  over_the_stroke(moves, r, 4.0, full(r));
  return finished(moves);
}

Trajectory stroke_at_speeds(const MotionRange& r) {
  auto moves = begun(r);
  for (const double seconds : {5.0, 2.5, 1.5, 0.8, 0.4}) over_the_stroke(moves, r, seconds, full(r));
  return finished(moves);
}

Trajectory stroke_at_accelerations(const MotionRange& r) {
  auto moves = begun(r);
  for (const double share : {0.05, 0.15, 0.4, 1.0})
    for (int turn = 0; turn < 2; ++turn) over_the_stroke(moves, r, 0.0, up_to(r, share));
  over_the_stroke(moves, r, 5.0, full(r));
  return finished(moves);
}

// Waves of equal speed at frequencies an octave apart, faded in and out.
struct Swings {
  static constexpr std::array frequencies{0.4, 0.8, 1.6, 3.2, 6.4, 12.8, 25.6};  // Hz
  static constexpr double fade = 0.5;                                            // s
  double begin, end;                                                             // s
  double speed;                                                                  // m/s, of each wave

  static double speed_for(double acceleration) {
    return acceleration / (2.0 * std::numbers::pi * std::accumulate(frequencies.begin(), frequencies.end(), 0.0));
  }
  AxisSetPoint at(double t) const {
    if (t <= begin || t >= end) return {};
    AxisSetPoint m;
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      const double w = 2.0 * std::numbers::pi * frequencies[k];
      // Phases that keep the peaks apart (Schroeder 1970).
      const double phase = w * (t - begin) - std::numbers::pi * static_cast<double>(k * k) / frequencies.size();
      m.position += speed / w * std::sin(phase);
      m.velocity += speed * std::cos(phase);
      m.acceleration -= speed * w * std::sin(phase);
    }
    const double inside = std::min(t - begin, end - t), sign = t - begin < end - t ? 1.0 : -1.0;
    if (inside >= fade) return m;
    const double u = inside / fade;
    const double e = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    const double e1 = sign * 30.0 * u * u * (1.0 - u) * (1.0 - u) / fade;
    const double e2 = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (fade * fade);
    return {e * m.position, e1 * m.position + e * m.velocity,
            e2 * m.position + 2.0 * e1 * m.velocity + e * m.acceleration};
  }
};

Trajectory together(const Trajectory& base, const std::vector<Swings>& swings) {
  return {"", base.duration, [base, swings](double t) {
            auto point = base.at(t);
            for (const auto& s : swings) {
              const auto more = s.at(t);
              point.position += more.position;
              point.velocity += more.velocity;
              point.acceleration += more.acceleration;
            }
            return point;
          }};
}

Trajectory swings_at_speed(const MotionRange& r) {
  auto moves = begun(r);
  std::vector<Swings> swings;
  // The swings leave their own way at both ends free.
  const double way = 0.9 * stroke(r), speed = std::min(way / 8.0, r.speed);
  // Together they stay below the speed: no reversal.
  const double each =
      std::min(0.8 * speed / static_cast<double>(Swings::frequencies.size()), Swings::speed_for(0.8 * r.acceleration));
  for (const double sign : {1.0, -1.0}) {
    moves.move(sign * way, speed, full(r));
    swings.push_back({moves.cruise_begin(), moves.cruise_end(), each});
    moves.rest(0.1);
  }
  return together(finished(moves), swings);
}

Trajectory swings_about_standstill(const MotionRange& r) {
  constexpr double length = 16.0;  // s
  // The ways of all waves together are less than twice that of the slowest.
  const double slowest = 2.0 * std::numbers::pi * Swings::frequencies.front();
  const double each = std::min({Swings::speed_for(0.9 * r.acceleration), 0.25 * stroke(r) * slowest,
                                r.speed / static_cast<double>(Swings::frequencies.size())});
  auto moves = begun(r);
  const double middle = 2.0 * each / slowest;
  moves.move(middle, 0.25 * r.speed, full(r));
  const Swings swings{moves.duration(), moves.duration() + length, each};
  moves.rest(length);
  moves.move(-middle, 0.25 * r.speed, full(r));
  return together(finished(moves), {swings});
}

Trajectory stations(const MotionRange& r) {
  constexpr int count = 6;
  auto moves = begun(r);
  for (const double sign : {1.0, -1.0})
    for (int k = 0; k < count; ++k) {
      moves.rest(1.0);
      moves.move(sign * stroke(r) / count, 0.25 * r.speed, {0.25 * r.acceleration, 0.25 * r.jerk});
    }
  moves.rest(1.0);
  return finished(moves);
}

Trajectory warm_up(const MotionRange& r) {
  auto moves = begun(r);
  const double fastest = speed_within(stroke(r), r.speed, 0.2, full(r));
  const auto look = [&] {
    for (const double share : {0.03, 0.2, 1.0}) both_ways(moves, r, share * fastest, 0.3, 1e-3);
  };
  for (int round = 0; round < 4; ++round) {
    look();
    const double begin = moves.duration();
    while (moves.duration() < begin + 5.0) over_the_stroke(moves, r, 0.0, full(r));
  }
  look();
  return finished(moves);
}

constexpr std::array table{
    SeparatingTrajectory{
        "constant speeds",
        "ten constant speeds from creeping to the highest, each both ways: friction over speed, by direction",
        constant_speeds},
    SeparatingTrajectory{"slow speeds", "nine speeds from 0.2 to 40 mm/s, each both ways: friction near standstill",
                         crawls},
    SeparatingTrajectory{"small reversals", "reversals with amplitudes of 5 um to 2 mm: presliding and backlash",
                         reversals},
    SeparatingTrajectory{"accelerations",
                         "short moves both ways at seven levels of acceleration: mass, force per ampere",
                         accelerations},
    SeparatingTrajectory{"slow sweep", "the stroke both ways, slowly and at twice the speed: dependence on position",
                         sweep},
    SeparatingTrajectory{"stroke at several speeds",
                         "the stroke both ways at five speeds: ripple over position, over time and over the signal "
                         "period of the encoder",
                         stroke_at_speeds},
    SeparatingTrajectory{"stroke at several accelerations",
                         "the stroke both ways with four accelerations: ripple that grows with the current",
                         stroke_at_accelerations},
    SeparatingTrajectory{"oscillation about a constant speed",
                         "oscillation of 0.4 to 26 Hz about a constant speed, without a reversal: lags and inertia",
                         swings_at_speed},
    SeparatingTrajectory{"oscillation about standstill",
                         "oscillation of 0.4 to 26 Hz with many reversals: delays, inertia and friction together",
                         swings_about_standstill},
    SeparatingTrajectory{"stations", "rests of one second at seven positions: forces at standstill", stations},
    SeparatingTrajectory{
        "warm-up", "three speeds both ways, repeated between fast runs: dependence on time or temperature", warm_up},
};

}  // namespace

std::span<const SeparatingTrajectory> separating_trajectories() { return table; }

}  // namespace stiction::sim
