#include "sim/cam/shaping/wave_lift.hpp"

#include <array>
#include <cmath>

#include "sim/cam/hermite.hpp"

namespace stiction::sim::cam {
namespace {

// What the wave has not yet brought when a polynomial takes over, of the stroke.
constexpr double still_coming = 1e-3;
constexpr double wave_taken_over = 0.1;  // of the rise: as long as that polynomial is
constexpr int wave_nodes = 240;          // of the rise
constexpr int steps_of_wave = 8;         // of Runge and Kutta's rule
// The lengths of the polynomial that are tried, of the rise.
constexpr double longest_polynomial = 0.9, shortest_polynomial = 0.2, step_of_polynomial = 0.01;

// Position, speed and acceleration over time.
using WavePoint = std::array<double, 3>;

// From 0 to 1 within 0 .. `length`.
WavePoint half_sent_off(double t, double length) {
  const double s = t / length;
  if (s >= 1.0) return {0.5, 0.0, 0.0};
  return {0.5 * s * s * s * (10.0 + s * (-15.0 + 6.0 * s)), 15.0 * s * s * (1.0 - s) * (1.0 - s) / length,
          30.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (length * length)};
}

// Motor, load, the wave on its way to the load and the one that comes back: position and speed of each.
using WaveState = std::array<double, 8>;

class Waves {
 public:
  Waves(const ElasticDrive& drive, double length)
      : drive_(drive),
        length_(length),
        square_(2.0 * drive.shaft_stiffness / drive.load_inertia),
        w_(std::sqrt(square_)) {}

  // The set-point at the time `t`.
  WavePoint set_point(const WaveState& x, double t) const {
    const auto half = half_sent_off(t, length_);
    return {half[0] + x[6], half[1] + x[7], half[2] + of_returning(x)};
  }
  void step(WaveState& x, double t, double h) const {
    const auto moved = [&](const WaveState& by, double share) {
      WaveState next = x;
      for (std::size_t k = 0; k < next.size(); ++k) next[k] += share * by[k];
      return next;
    };
    const WaveState a = rate(x, t), b = rate(moved(a, 0.5 * h), t + 0.5 * h), c = rate(moved(b, 0.5 * h), t + 0.5 * h),
                    d = rate(moved(c, h), t + h);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
  }

 private:
  // Second derivative of the wave that comes back.
  double of_returning(const WaveState& x) const { return square_ * (x[2] - x[4] - x[6]) - w_ * x[7]; }
  WaveState rate(const WaveState& x, double t) const {
    const auto wanted = set_point(x, t);
    const double shaft = drive_.shaft_stiffness * (x[0] - x[2]) + drive_.shaft_damping * (x[1] - x[3]);
    const double motor = drive_.drive_stiffness * (wanted[0] - x[0]) + drive_.drive_damping * (wanted[1] - x[1]);
    const double launched = x[0] - x[6];
    return {x[1], (motor - shaft) / drive_.rotor_inertia,  x[3], shaft / drive_.load_inertia,
            x[5], square_ * (launched - x[4]) - w_ * x[5], x[7], of_returning(x)};
  }

  ElasticDrive drive_;
  double length_, square_, w_;
};

// The lift with a polynomial of `length` (s); none where the wave is not back in time.
std::optional<Curve> with_polynomial(const ShapingTask& task, double length) {
  const Waves waves(task.drive, length);
  const double step = task.rise_time() / wave_nodes, w = task.master_speed;
  const int last = static_cast<int>(std::lround((1.0 - wave_taken_over) * wave_nodes));
  std::vector<Piece> pieces;
  const auto add = [&](double begin, double end, const WavePoint& from, const WavePoint& to) {
    const double h = end - begin;
    const auto state = [&](const WavePoint& p) {
      return EndState{p[0] * task.stroke, p[1] * h * task.stroke, p[2] * h * h * task.stroke, 0.0};
    };
    Piece piece = polynomial_piece(task.begin + begin * w, task.begin + end * w, quintic(state(from), state(to)));
    piece.rate = 1.0 / (h * w);
    piece.polynomial[0] += task.start;
    pieces.push_back(std::move(piece));
  };
  WaveState x{};
  WavePoint before = waves.set_point(x, 0.0);
  for (int k = 0; k < last; ++k) {
    for (int i = 0; i < steps_of_wave; ++i) waves.step(x, k * step + i * step / steps_of_wave, step / steps_of_wave);
    const WavePoint next = waves.set_point(x, (k + 1) * step);
    add(k * step, (k + 1) * step, before, next);
    before = next;
  }
  const double left = wave_taken_over * task.rise_time();
  if (std::fabs(before[0] - 1.0) > still_coming || std::fabs(before[1]) * left > 5.0 * still_coming)
    return std::nullopt;
  add(last * step, task.rise_time(), before, {1.0, 0.0, 0.0});
  return Curve(std::move(pieces));
}

}  // namespace

std::optional<Curve> wave_lift(const ShapingTask& task) {
  for (double share = longest_polynomial; share > shortest_polynomial; share -= step_of_polynomial)
    if (auto lift = with_polynomial(task, share * task.rise_time())) return lift;
  return std::nullopt;
}

}  // namespace stiction::sim::cam
