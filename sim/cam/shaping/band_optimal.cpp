#include "sim/cam/shaping/band_optimal.hpp"

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace stiction::sim::cam {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr int nodes = 100;             // intervals of the polygon of accelerations
constexpr int frequencies = 17;        // over the band
constexpr int directions = 32;         // of a polygon in place of a circle: at most 0.5 % too small
constexpr int samples_of_period = 24;  // of the dwell

// How much of the mode `pole` (rad over the rise) a unit of the acceleration at each node leaves at the time `t` (in
// rises): the integral of its hat function times e^(pole (t - x)).
std::vector<Complex> weights(Complex pole, double t) {
  constexpr double h = 1.0 / nodes;
  const Complex half = 0.5 * h * pole, shape = std::sinh(half) / half;
  std::vector<Complex> found;
  for (int k = 0; k <= nodes; ++k) found.push_back(h * shape * shape * std::exp(pole * (t - k * h)));
  return found;
}

struct Solution {
  std::vector<double> acceleration;  // at the nodes, of the unit law
  double bound = 0.0;
};

// The accelerations that make the largest of `rows` times them smallest.
std::optional<Solution> solve(const std::vector<std::vector<double>>& rows, const LiftLimits& limits) {
  constexpr int columns = nodes + 2;  // the last one is the bound
  constexpr double h = 1.0 / nodes;
  const double inf = COIN_DBL_MAX;
  CoinPackedMatrix matrix(false, 0.0, 0.0);
  matrix.setDimensions(0, columns);
  std::vector<double> lower, upper;
  std::vector<int> index;
  std::vector<double> value;
  const auto append = [&](double low, double high) {
    matrix.appendRow(static_cast<int>(index.size()), index.data(), value.data());
    lower.push_back(low);
    upper.push_back(high);
    index.clear();
    value.clear();
  };
  const auto add = [&](int column, double v) {
    index.push_back(column);
    value.push_back(v);
  };
  // At the end no speed, and the stroke.
  for (int k = 1; k < nodes; ++k) add(k, h);
  append(0.0, 0.0);
  for (int k = 1; k < nodes; ++k) add(k, h * (1.0 - k * h));
  append(1.0, 1.0);
  for (int k = 0; k < nodes; ++k) {
    add(k, -1.0);
    add(k + 1, 1.0);
    append(-limits.jerk * h, limits.jerk * h);
  }
  // The speed at a node, by trapezoids.
  for (int k = 1; k < nodes; ++k) {
    for (int i = 1; i < k; ++i) add(i, h);
    add(k, 0.5 * h);
    append(-limits.speed, limits.speed);
  }
  for (const auto& row : rows) {
    for (int k = 1; k < nodes; ++k) add(k, row[static_cast<std::size_t>(k)]);
    add(nodes + 1, -1.0);
    append(-inf, 0.0);
  }
  std::vector<double> low(columns, -limits.acceleration), high(columns, limits.acceleration), cost(columns, 0.0);
  low[0] = high[0] = low[nodes] = high[nodes] = 0.0;
  low[nodes + 1] = 0.0;
  high[nodes + 1] = inf;
  cost[nodes + 1] = 1.0;
  ClpSimplex programme;
  programme.setLogLevel(0);
  programme.loadProblem(matrix, low.data(), high.data(), cost.data(), lower.data(), upper.data());
  programme.dual();
  if (!programme.isProvenOptimal()) return std::nullopt;
  const double* solution = programme.primalColumnSolution();
  return Solution{{solution, solution + nodes + 1}, solution[nodes + 1]};
}

// The unit law's polygon of accelerations as a lift of the task.
Curve lift_of(const ShapingTask& task, const std::vector<double>& acceleration) {
  constexpr double h = 1.0 / nodes;
  std::vector<Piece> pieces;
  double y = 0.0, v = 0.0;
  for (int k = 0; k < nodes; ++k) {
    const double a = acceleration[static_cast<std::size_t>(k)], b = acceleration[static_cast<std::size_t>(k) + 1];
    const double from = task.begin + task.length() * k * h;
    const double to = k + 1 == nodes ? task.end() : task.begin + task.length() * (k + 1) * h;
    const double z = task.stroke;
    Piece piece =
        polynomial_piece(from, to, {task.start + z * y, z * v * h, 0.5 * z * a * h * h, z * (b - a) / 6.0 * h * h});
    piece.rate = 1.0 / (to - from);
    pieces.push_back(std::move(piece));
    y += v * h + (a / 3.0 + b / 6.0) * h * h;
    v += 0.5 * (a + b) * h;
  }
  return Curve(std::move(pieces));
}

double factor_of(int k, double band) { return 1.0 - band + 2.0 * band * k / (frequencies - 1); }

}  // namespace

std::optional<OptimalLift> band_optimal_lift(const ShapingTask& task) {
  std::vector<std::vector<double>> rows;
  const double rise = task.rise_time();
  for (int f = 0; f < frequencies; ++f) {
    const auto drive = task.drive.with_load_frequency(factor_of(f, task.band));
    const auto g = transfer_function(drive);
    const auto poles = g.poles();
    const double period = load_mode(drive).period();
    for (int s = 0; s < samples_of_period; ++s) {
      const double t = 1.0 + 1.05 * period / rise * s / (samples_of_period - 1);
      // y - stroke is the sum over the poles of N(p)/D'(p)/p^2 times the integral of u'' e^(p (t - x)).
      std::vector<double> row(nodes + 1, 0.0);
      for (const Complex& p : poles) {
        const Complex slope =
            ((4.0 * g.denominator[4] * p + 3.0 * g.denominator[3]) * p + 2.0 * g.denominator[2]) * p + g.denominator[1];
        const Complex numerator = (g.numerator[2] * p + g.numerator[1]) * p + g.numerator[0];
        // With time in rises: u'' of the unit law over rise^2, and its integral a rise.
        const Complex share = numerator / slope / (p * p) / rise;
        const auto of_nodes = weights(p * rise, t);
        for (std::size_t k = 0; k < row.size(); ++k) row[k] += 2.0 * (share * of_nodes[k]).real();
      }
      rows.push_back(row);
      for (double& each : row) each = -each;
      rows.push_back(row);
    }
  }
  const auto found = solve(rows, task.limits);
  if (!found) return std::nullopt;
  return OptimalLift{lift_of(task, found->acceleration), found->bound * std::fabs(task.stroke)};
}

std::optional<double> least_residual(double periods, double damping_ratio, double band, const LiftLimits& limits) {
  std::vector<std::vector<double>> rows;
  for (int f = 0; f < frequencies; ++f) {
    // Over the rise, of a load whose frequency as nominal has these periods in it.
    const double w = 2.0 * pi * periods * factor_of(f, band), root = std::sqrt(1.0 - damping_ratio * damping_ratio);
    const Complex p(-damping_ratio * w, w * root);
    const Complex residue = (w * w + 2.0 * damping_ratio * w * p) / (p - std::conj(p)) / (p * p);
    // From peak to peak the amplitude twice, the second time half a period later.
    const double both = 2.0 * (1.0 + std::exp(-pi * damping_ratio / root));
    const auto of_nodes = weights(p, 1.0);
    for (int d = 0; d < directions; ++d) {
      std::vector<double> row;
      for (const Complex& each : of_nodes)
        row.push_back(both * (residue * each * std::polar(1.0, 2.0 * pi * d / directions)).real());
      rows.push_back(std::move(row));
    }
  }
  const auto found = solve(rows, limits);
  if (!found) return std::nullopt;
  return found->bound;
}

std::vector<FrontierPoint> frontier(double from, double to, int count, double damping_ratio, double band,
                                    const LiftLimits& limits) {
  std::vector<FrontierPoint> points;
  for (int k = 0; k < count; ++k) {
    const double periods = from + (to - from) * k / std::max(1, count - 1);
    if (const auto residual = least_residual(periods, damping_ratio, band, limits))
      points.push_back({periods, *residual});
  }
  return points;
}

std::optional<double> shortest_rise(double residual, double damping_ratio, double band, const LiftLimits& limits) {
  const auto possible = [&](double periods) {
    const auto least = least_residual(periods, damping_ratio, band, limits);
    return least && *least <= residual;
  };
  double low = 0.25, high = 0.5;
  while (!possible(high)) {
    low = high;
    high += 0.25;
    if (high > 8.0) return std::nullopt;
  }
  while (high - low > 0.005) {
    const double middle = 0.5 * (low + high);
    (possible(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace stiction::sim::cam
