#include "host/tune/friction_tuning.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "firmware/machine/model/motor_force.hpp"
#include "host/algebra/least_squares.hpp"
#include "host/identify/contact.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/log_rows.hpp"
#include "host/tune/nonnegative.hpp"
#include "host/tune/presliding_elements.hpp"

namespace stiction::host {
namespace {

using Index = Eigen::Index;

constexpr double shortest = 1e-6, longest = 1.8e-3;  // m, of the stop operators; the drive's format ends at 1.9 mm
constexpr double slowest_node = 0.4e-3;              // m/s, of the sliding curve
constexpr double node_ratio = 1.6;                   // from node to node
constexpr double longest_damping = 8e-3;             // s
constexpr double damping_step = 0.25e-3;             // s

std::vector<double> distances(int per_decade) {
  std::vector<double> d;
  for (double x = shortest; x <= longest; x *= std::pow(10.0, 1.0 / per_decade)) d.push_back(x);
  return d;
}

std::vector<double> node_speeds(double fastest) {
  std::vector<double> v;
  for (double speed = fastest; speed >= slowest_node; speed /= node_ratio) v.push_back(speed);
  std::reverse(v.begin(), v.end());
  return v;
}

// Weight of node k at a speed: tents between neighbours, from zero at rest; the last one goes on with its slope.
double tent(const std::vector<double>& nodes, std::size_t k, double speed) {
  const double before = k == 0 ? 0.0 : nodes[k - 1];
  if (k + 1 == nodes.size() && speed >= nodes[k]) return 1.0;
  if (speed <= before) return 0.0;
  if (speed <= nodes[k]) return (speed - before) / (nodes[k] - before);
  return speed < nodes[k + 1] ? (nodes[k + 1] - speed) / (nodes[k + 1] - nodes[k]) : 0.0;
}

// The columns of the fit in the order: stop operators, their rates, sliding forward, sliding backward, acceleration, a
// constant for each log. Kept as normal equations; every log counts the same.
struct Equations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
  double square = 0.0;  // of the current
  Index operators = 0, nodes = 0, logs = 0;
};

// 1 where the stop operators have forgotten the log's unknown start: it has once moved as far as the longest reaches.
std::vector<double> settled(const Motion& motion) {
  std::vector<double> mask(motion.x.size(), 0.0);
  double low = motion.x.front(), high = low;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    low = std::min(low, motion.x[i]);
    high = std::max(high, motion.x[i]);
    mask[i] = high - low > longest ? 1.0 : 0.0;
  }
  return mask;
}

Equations equations(const LogRows& rows, const std::vector<double>& d, const std::vector<double>& v, double constant) {
  Equations q;
  q.operators = static_cast<Index>(d.size());
  q.nodes = static_cast<Index>(v.size());
  q.logs = static_cast<Index>(rows.logs().size());
  const Index n = 2 * q.operators + 2 * q.nodes + 1 + q.logs;
  Eigen::MatrixXd columns(rows.rows(), n);
  // Four columns are filtered as fast as one, and more than four need memory without being faster.
  for (Index first = 0; first < q.operators; first += 2) {
    const Index count = std::min<Index>(2, q.operators - first);
    const auto filtered = rows.stacked_together([&](const Motion& m) {
      std::vector<std::vector<double>> levels;
      for (Index k = first; k < first + count; ++k) {
        const double reach = 0.5 * d[static_cast<std::size_t>(k)];
        auto& level = levels.emplace_back(stop_operator(m, reach));
        for (double& x : level) x /= reach;
      }
      for (Index k = 0; k < count; ++k)
        levels.push_back(central_difference(levels[static_cast<std::size_t>(k)], m.period));
      return levels;
    });
    for (Index k = 0; k < count; ++k) {
      columns.col(first + k) = filtered[static_cast<std::size_t>(k)];
      columns.col(q.operators + first + k) = filtered[static_cast<std::size_t>(count + k)];
    }
  }
  for (Index first = 0; first < q.nodes; first += 2) {
    const Index count = std::min<Index>(2, q.nodes - first);
    const auto filtered = rows.stacked_together([&](const Motion& m) {
      std::vector<std::vector<double>> sliding(static_cast<std::size_t>(2 * count),
                                               std::vector<double>(m.v.size(), 0.0));
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
        for (std::size_t i = 0; i < m.v.size(); ++i) {
          const double weight = tent(v, static_cast<std::size_t>(first) + k, std::abs(m.v[i]));
          if (m.v[i] > 0.0) sliding[2 * k][i] = weight;
          if (m.v[i] < 0.0) sliding[2 * k + 1][i] = -weight;
        }
      return sliding;
    });
    for (Index k = 0; k < count; ++k) {
      columns.col(2 * q.operators + first + k) = filtered[static_cast<std::size_t>(2 * k)];
      columns.col(2 * q.operators + q.nodes + first + k) = filtered[static_cast<std::size_t>(2 * k + 1)];
    }
  }
  columns.col(n - 1 - q.logs) = rows.acceleration;
  for (Index k = 0; k < q.logs; ++k) {
    const auto log = static_cast<std::size_t>(k);
    columns.col(n - q.logs + k) = rows.of_log(log, std::vector<double>(rows.motions()[log].x.size(), 1.0));
  }
  Eigen::VectorXd weight = rows.sampled(settled);
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const auto begin = static_cast<Index>(rows.logs()[k]);
    const auto end = static_cast<Index>(rows.end(k));
    const double count = weight.segment(begin, end - begin).sum();
    if (count > 0.0) weight.segment(begin, end - begin) /= count * static_cast<double>(rows.logs().size());
  }
  const Eigen::VectorXd current = rows.force / constant;
  const Eigen::MatrixXd weighted = weight.asDiagonal() * columns;
  q.normal = transposed_product(columns, weighted);
  q.right = transposed_times(weighted, current);
  q.square = current.dot(weight.asDiagonal() * current);
  return q;
}

struct Fit {
  Eigen::VectorXd w;  // stop operators, sliding forward, backward, acceleration, constants
  double square = 0.0;
};

// With the rate of every operator counted by `damping` s.
Fit fit_with(const Equations& q, double damping) {
  const Index n = q.right.size() - q.operators;
  Eigen::MatrixXd pick = Eigen::MatrixXd::Zero(q.right.size(), n);
  for (Index k = 0; k < q.operators; ++k) {
    pick(k, k) = 1.0;
    pick(q.operators + k, k) = damping;
  }
  for (Index k = q.operators; k < n; ++k) pick(q.operators + k, k) = 1.0;
  Eigen::MatrixXd normal = pick.transpose() * q.normal * pick;
  const Eigen::VectorXd right = pick.transpose() * q.right;
  // What the data say nothing of: both directions alike, and no curvature between neighbouring speeds.
  const double ridge = 1e-7 * normal.topLeftCorner(q.operators, q.operators).trace() / static_cast<double>(q.operators);
  for (Index k = 0; k < q.nodes; ++k) {
    const Index forward = q.operators + k, backward = forward + q.nodes;
    normal(forward, forward) += 100.0 * ridge;
    normal(backward, backward) += 100.0 * ridge;
    normal(forward, backward) -= 100.0 * ridge;
    normal(backward, forward) -= 100.0 * ridge;
    for (const Index at : {forward, backward}) {
      if (k == 0 || k + 1 == q.nodes) continue;
      const std::array<std::pair<Index, double>, 3> bend{{{at - 1, 1.0}, {at, -2.0}, {at + 1, 1.0}}};
      for (const auto& [i, a] : bend)
        for (const auto& [j, b] : bend) normal(i, j) += 10.0 * ridge * a * b;
    }
  }
  normal.diagonal().array() += 1e-2 * ridge;
  Fit fit{solve_nonnegative(normal, right, q.operators), 0.0};
  fit.square = std::max(0.0, q.square - 2.0 * fit.w.dot(right) + fit.w.dot(pick.transpose() * q.normal * pick * fit.w));
  return fit;
}

// Damping costs the drive noise and gains little where the contact has none: it must take a tenth of the square away.
std::pair<Fit, double> best_damping(const Equations& q) {
  const Fit without = fit_with(q, 0.0);
  Fit best = without;
  double chosen = 0.0;
  for (double damping = damping_step; damping <= longest_damping; damping += damping_step) {
    Fit fit = fit_with(q, damping);
    if (fit.square >= best.square) continue;
    best = std::move(fit);
    chosen = damping;
  }
  if (best.square > 0.9 * without.square) return {without, 0.0};
  return {best, chosen};
}

void check_rows(const std::vector<Log>& logs, const LogRows& rows) {
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto mask = settled(rows.motions()[k]);
    if (mask.back() > 0.0) continue;
    throw LogError(
        fmt::format("{}: found a motion over less than {:g} mm; expected one that slides beyond the presliding range, "
                    "such as a circle",
                    logs[k].source, longest * 1e3));
  }
}

}  // namespace

double expected_look_ahead(const machine::Timing& timing, const machine::AxisModel& axis) {
  return 1.5 * timing.fast_period + axis.inverter.dead_time;
}

FrictionTuning tune_friction(const std::vector<Log>& logs, const machine::AxisModel& axis,
                             const TuningSettings& settings) {
  std::vector<Motion> motions;
  for (const auto& log : logs) {
    const auto& channels = channels_of(log, axis);
    if (channels.x.size() < 100)
      throw LogError(fmt::format("{}: found {} samples; expected at least 100", log.source, channels.x.size()));
    motions.push_back(motion_of(log, channels, axis, settings.amperes, settings.signals));
  }
  const LogRows rows(std::move(motions), settings.signals);
  check_rows(logs, rows);
  double fastest = 0.0;
  for (const auto& motion : rows.motions())
    for (const double v : motion.v) fastest = std::max(fastest, std::abs(v));

  const auto d = distances(settings.per_decade);
  const auto v = node_speeds(fastest);
  const Equations q = equations(rows, d, v, machine::acting_force_constant(axis.motor));
  const auto best = best_damping(q);
  const Fit& fit = best.first;  // no structured binding: clang captures none

  FrictionTuning t;
  const std::vector<double> levels(fit.w.data(), fit.w.data() + q.operators);
  const auto elements = draw_together(d, levels, compensation_element_count);
  t.reduction_error = elements.error;
  t.friction.distance = elements.distance;
  t.friction.level = elements.level;
  t.friction.contact_damping = best.second;
  t.friction.speed = v;
  const auto curve = [&](Index from) {
    return std::vector<double>(fit.w.data() + from, fit.w.data() + from + q.nodes);
  };
  t.friction.forward = curve(q.operators);
  t.friction.backward = curve(q.operators + q.nodes);
  for (const double level : t.friction.level) t.coulomb += level;
  const Index mass = q.operators + 2 * q.nodes;
  t.mass = fit.w[mass] * machine::acting_force_constant(axis.motor);
  t.constant_current = fit.w[mass + 1];
  t.residual_rms = std::sqrt(fit.square);
  const double of_mass = fit.w[mass];
  const Index a = q.right.size() - 1 - q.logs;
  t.current_rms = std::sqrt(std::max(0.0, q.square - 2.0 * of_mass * q.right[a] + of_mass * of_mass * q.normal(a, a)));
  if (t.coulomb < 0.05 * t.current_rms)
    t.notes.push_back("hardly any presliding was found: friction changes its sign with speed, not with displacement");
  if (fastest < 0.5 * axis.max_velocity)
    t.notes.push_back(fmt::format(
        "the sliding curve ends at {:.3g} m/s, the highest speed of the logs; beyond it is extrapolated linearly",
        fastest));
  return t;
}

}  // namespace stiction::host
