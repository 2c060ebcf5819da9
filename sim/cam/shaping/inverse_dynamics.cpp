#include "sim/cam/shaping/inverse_dynamics.hpp"

#include <array>
#include <cmath>

#include "sim/cam/hermite.hpp"
#include "sim/cam/shaping/lift.hpp"

namespace stiction::sim::cam {
namespace {

// What is left of the tail is bridged by a polynomial: a millionth of the stroke, 3e-5 degrees of 30.
constexpr double negligible = 1e-6;
constexpr double node_step = 0.25e-3;  // s
constexpr int steps_per_node = 16;     // of Runge and Kutta's rule; the fast zero of the stand has 0.27 ms

}  // namespace

std::optional<Curve> inverse_lift(const ShapingTask& task, std::string_view law) {
  const auto g = transfer_function(task.drive);
  Lift wanted;
  wanted.add(law_curve(law, task.begin, task.length(), task.stroke));
  const double w = task.master_speed;
  // The right side of n2 u'' + n1 u' + n0 u = D(d/dt) y, over time.
  const auto right = [&](double master) {
    double sum = 0.0, power = 1.0;
    for (int k = 0; k < 5; ++k, power *= w)
      sum += g.denominator[static_cast<std::size_t>(k)] * power * wanted.derivative(master, k, Side::left);
    return sum;
  };
  const auto& n = g.numerator;
  using Input = std::array<double, 2>;  // u, u'
  const auto rate = [&](const Input& u, double p) {
    return n[2] > 0.0 ? Input{u[1], (p - n[0] * u[0] - n[1] * u[1]) / n[2]} : Input{(p - n[0] * u[0]) / n[1], 0.0};
  };
  const auto moved = [](const Input& u, const Input& by, double h) {
    return Input{u[0] + h * by[0], u[1] + h * by[1]};
  };
  const int nodes = std::max(1, static_cast<int>(std::ceil(task.rise_time() / node_step)));
  const double step = task.rise_time() / nodes, h = step / steps_per_node;
  const double dwell_time = task.dwell.length / w;
  Input u{0.0, 0.0};
  // Without the fast zero the speed follows from the equation itself.
  const auto state = [&](double t) {
    const Input now = rate(u, right(task.begin + t * w));
    if (n[2] > 0.0) return EndState{u[0], u[1] * step, now[1] * step * step, 0.0};
    const double before = rate(u, right(task.begin + (t - 1e-3 * h) * w))[0];
    return EndState{u[0], now[0] * step, (now[0] - before) / (1e-3 * h) * step * step, 0.0};
  };
  std::vector<Piece> pieces;
  const auto add = [&](double t, const EndState& from, const EndState& to) {
    Piece piece = polynomial_piece(task.begin + t * w, task.begin + (t + step) * w, quintic(from, to));
    piece.rate = 1.0 / (step * w);
    piece.polynomial[0] += task.start;
    pieces.push_back(std::move(piece));
  };
  EndState last{};
  for (int k = 0;; ++k) {
    const double begin = k * step;
    const bool still = k >= nodes && std::fabs(u[0] - task.stroke) < negligible * std::fabs(task.stroke);
    if (still) {
      add(begin, last, {task.stroke, 0.0, 0.0, 0.0});
      return Curve(std::move(pieces));
    }
    if (begin + 2.0 * step > task.rise_time() + dwell_time) return std::nullopt;
    for (int i = 0; i < steps_per_node; ++i) {
      const double t = begin + i * h;
      const double p0 = right(task.begin + t * w), p1 = right(task.begin + (t + 0.5 * h) * w),
                   p2 = right(task.begin + (t + h) * w);
      const Input a = rate(u, p0), b = rate(moved(u, a, 0.5 * h), p1), c = rate(moved(u, b, 0.5 * h), p1),
                  d = rate(moved(u, c, h), p2);
      for (std::size_t j = 0; j < 2; ++j) u[j] += h / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
    }
    const EndState next = state(begin + step);
    add(begin, last, next);
    last = next;
  }
}

}  // namespace stiction::sim::cam
