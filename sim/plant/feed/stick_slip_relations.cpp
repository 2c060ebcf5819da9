// Jump and critical feed of a stick-slip feed: see stick_slip_relations.hpp.
#include "sim/plant/feed/stick_slip_relations.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace stiction::sim {
namespace {

// Relative to the natural frequency and the step of friction, the deflection beyond sliding equilibrium obeys
// w'' + 2 zeta w' + w = 0; at break-away w' = beta and, spring and damper together, w = 1 - 2 zeta beta. The largest w'
// after the first descent: at or above beta the carriage stops again.
double greatest_rate(double beta, double zeta) {
  const double damped = std::sqrt(1.0 - zeta * zeta);
  const double w = 1.0 - 2.0 * zeta * beta;
  // w' = exp(-zeta t) (a cos + b sin), w'' = exp(-zeta t) (a2 cos + b2 sin) of damped * t
  const double a = beta, b = (-w - zeta * beta) / damped;
  const double a2 = -zeta * a + damped * b, b2 = -zeta * b - damped * a;
  // w'' begins at -1; its second zero is the maximum of w'.
  double angle = std::atan2(-a2, b2);
  while (angle <= 0.0) angle += std::numbers::pi;
  angle += std::numbers::pi;
  return std::exp(-zeta * angle / damped) * (a * std::cos(angle) + b * std::sin(angle));
}

// The carriage no longer stops when its oscillation has decayed by exp(-12).
double settling_time(const machine::FeedDrive& drive) {
  const double omega = drive.carriage.natural_frequency();
  return std::min(12.0 / (std::max(drive.carriage.damping_ratio, 1e-6) * omega),
                  200.0 * 2.0 * std::numbers::pi / omega);
}

constexpr std::size_t cycles_before = 8, cycles_measured = 4;

}  // namespace

double small_feed_jump_ratio(double beta, double zeta) {
  return 0.5 * (1.0 + std::exp(-std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta))) +
         0.5 * std::numbers::pi * beta;
}

double critical_beta(double zeta) {
  double low = 0.0, high = 1.0;
  while (greatest_rate(high, zeta) > high) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (greatest_rate(middle, zeta) > middle ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double critical_feed_of_ideal_drive(const machine::FeedDrive& drive) {
  const auto& c = drive.carriage;
  return critical_beta(c.damping_ratio) * drive.friction.step() / std::sqrt(c.stiffness * c.mass);
}

bool loops_are_stable(const machine::FeedDrive& drive) {
  // (7) without set-point is linear: its columns are the derivatives of the unit states.
  const FeedSystem system(drive, FeedSource::pi_drive, {}, 0.0);
  constexpr std::size_t size = feed_state::wind_up + 1;
  Eigen::MatrixXd matrix(size, size);
  for (std::size_t j = 0; j < size; ++j) {
    FeedState unit{};
    unit[j] = 1.0;
    const auto column = system.derivative(unit, false);
    for (std::size_t i = 0; i < size; ++i)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = column[i];
  }
  const auto decays = [](const Eigen::MatrixXd& m) { return m.eigenvalues().real().maxCoeff() < 0.0; };
  return decays(matrix) && decays(matrix.topLeftCorner(size - 1, size - 1));
}

Jumping jumping_at(const machine::FeedDrive& drive, FeedSource source, FeedEquations equations, double feed,
                   FeedAccuracy accuracy) {
  auto without_tool = drive;  // nothing acts back from it
  without_tool.tool.force_x = without_tool.tool.force_z = 0.0;
  StickSlipFeed run(without_tool, source, equations, feed, accuracy);
  const auto& friction = drive.friction;
  const double winding = 2.0 * (friction.normal_load * friction.static_long + drive.cutting.constant_force) /
                         (drive.carriage.stiffness * feed);
  const double settling = settling_time(drive);
  const std::size_t wanted = cycles_before + cycles_measured + 1;
  // A drive that takes many times longer is unstable itself.
  const double deadline = 20.0 * static_cast<double>(wanted) * (winding + settling);
  while (run.jumps().size() < wanted || run.sliding()) {
    const bool stopped = run.advance_to_standstill(run.time() + winding + settling);
    if (!stopped && run.sliding() && run.time() >= run.jumps().back().start + settling) return {};
    if (run.time() > deadline) return {};
  }
  Jumping result{true, {}};
  const auto& jumps = run.jumps();
  for (std::size_t i = cycles_before; i < cycles_before + cycles_measured; ++i) {
    constexpr double share = 1.0 / cycles_measured;
    result.cycle.travel += share * jumps[i].travel();
    result.cycle.period += share * (jumps[i + 1].start - jumps[i].start);
    result.cycle.slip_time += share * jumps[i].duration();
    result.cycle.dwell += share * jumps[i].dwell;
    result.cycle.break_away_force += share * jumps[i].break_away_force;
  }
  return result;
}

double critical_feed_by_bisection(const machine::FeedDrive& drive, FeedSource source, double relative) {
  // A step is accurate to 1e-8: beside the bisection's own width that is nothing.
  const auto jumps = [&](double feed) { return jumping_at(drive, source, {}, feed, {1e-8, 5e-4}).lasts; };
  const double guess = critical_feed_of_ideal_drive(drive);
  double low = guess, high = guess;
  while (!jumps(low)) {
    high = low;
    low *= 0.7;
    if (low < 0.01 * guess) return 0.0;
  }
  while (high == low || jumps(high)) {
    if (high > low) low = high;
    high = 1.4 * low;
    if (high > 100.0 * guess) return std::numeric_limits<double>::infinity();
  }
  while (high - low > relative * low) {
    const double middle = std::sqrt(low * high);
    (jumps(middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace stiction::sim
