// Lost motion between motor and measured position: the motor goes through the gap while the measured position stands.
// Its position is x + width/2 u, u the side of the gap that bears, from -1 to 1 in the time in which the measured
// position turns round. The column is what the file's own forces are for that motion less those for the measured one.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

constexpr double longest_crossing = 0.1;  // s; a longer standstill lets the crossing happen at its end

// -1 .. 1 along the motion, through the position's own filter.
std::vector<double> bearing_side(const Scene& scene, const Motion& motion) {
  const double still = 1e-3 * scene.highest_speed;
  std::vector<double> side(motion.v.size(), 0.0);
  double now = 0.0;
  std::size_t last = 0;  // with a speed in direction `now`
  for (std::size_t i = 0; i < side.size(); ++i) {
    side[i] = now;
    if (std::abs(motion.v[i]) <= still) continue;
    const double direction = std::copysign(1.0, motion.v[i]);
    if (now != 0.0 && direction != now) {
      const auto longest = static_cast<std::size_t>(longest_crossing / motion.period);
      const std::size_t from = std::max(last, i > longest ? i - longest : 0);
      for (std::size_t k = from; k < i; ++k)
        side[k] =
            -direction * std::cos(std::numbers::pi * static_cast<double>(k - from) / static_cast<double>(i - from));
    } else if (now == 0.0) {
      std::fill(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(i), direction);
    }
    side[i] = now = direction;
    last = i;
  }
  const auto lowpass = butterworth(4, 2.0 * std::min(scene.signals.cutoff, 0.2 / motion.period) * motion.period);
  return filter_both_ways(lowpass, side, default_padding(lowpass));
}

std::vector<double> grid(const Scene&) { return {1e-6, 4e-6, 16e-6, 64e-6}; }

Columns columns(const Scene& scene, const Motion& motion, double width) {
  auto motor = motion;
  const auto side = bearing_side(scene, motion);
  for (std::size_t i = 0; i < side.size(); ++i) motor.x[i] += 0.5 * width * side[i];
  motor.v = central_difference(motor.x, motion.period, scene.signals.difference_points);
  motor.a = central_difference(motor.v, motion.period, scene.signals.difference_points);
  auto column = force_along(scene.axis, motor);
  const auto base = force_along(scene.axis, motion);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - base[i]) / width;
  return {column};
}
bool possible(const Scene&, double, const Eigen::VectorXd& w) { return w[0] > 0.0; }
void describe(const Scene&, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  add_key(finding, "width", "_m", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

const Candidate backlash{.name = "backlash",
                         .grid = grid,
                         .columns = columns,
                         .possible = possible,
                         .describe = describe,
                         .at_weight = true};

}  // namespace stiction::host::effects
