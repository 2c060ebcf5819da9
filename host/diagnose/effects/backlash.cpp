// Lost motion between motor and measured position. While the gap is crossed the measured position stands and the motor
// goes on as the set-points have it: what the drive cannot see it does not correct. So the motor is ahead of the
// measured position by what a play of this width leaves of the motion that the set-points make. The column is what the
// file's own forces are for the motor's motion less those for the measured one.
#include <algorithm>
#include <cmath>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

// Motor ahead of the measured position (m), through the position's own filter.
std::vector<double> ahead(const Scene& scene, const Motion& motion, double width) {
  std::vector<double> way(motion.x.size());
  double follower = motion.x.front();
  for (std::size_t i = 0; i < way.size(); ++i) {
    follower = std::clamp(follower, motion.x[i] - 0.5 * width, motion.x[i] + 0.5 * width);
    way[i] = motion.x[i] - follower;
  }
  const auto lowpass = butterworth(4, 2.0 * std::min(scene.signals.cutoff, 0.2 / motion.period) * motion.period);
  return filter_both_ways(lowpass, way, default_padding(lowpass));
}

std::vector<double> grid(const Scene&) { return {1e-6, 4e-6, 16e-6, 64e-6}; }

Columns columns(const Scene& scene, const Motion& motion, double width) {
  auto motor = motion;
  const auto way = ahead(scene, motion, std::abs(width));
  for (std::size_t i = 0; i < way.size(); ++i) motor.x[i] += way[i];
  motor.v = central_difference(motor.x, motion.period, scene.signals.difference_points);
  motor.a = central_difference(motor.v, motion.period, scene.signals.difference_points);
  auto column = force_along(scene.axis, motor);
  const auto base = force_along(scene.axis, motion);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - base[i]) / std::abs(width);
  return {column};
}
// A grid of fours: a width beyond the next value is described by that one.
bool possible(const Scene&, double width, const Eigen::VectorXd& w) {
  return w[0] > 0.25 * width && w[0] < 4.0 * width;
}
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
