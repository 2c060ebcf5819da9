// An elastic mode between motor and measured position: the force that bends it, ModeColumns. The weights are 1/w^2,
// 1/(r w^2) and 2 zeta/w^3: the mode's frequency from the share of inertia, the load's share of the mass from its
// friction at reversals, the damping from the next order.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

constexpr double least_ratio = 0.02, largest_ratio = 0.98;

Columns columns(const Scene& scene, const Motion& motion, double) {
  auto mode = mode_columns(scene.axis.mass, motion, force_along(scene.axis, motion));
  return {mode.inertia, mode.load, mode.damping};
}
// The load's mass is a part of the whole, 1/r above 1; as far as friction at reversals shows it at all.
bool possible(const Scene&, double, const Eigen::VectorXd& w) { return w[0] > 0.0; }
void describe(const Scene&, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  const double omega = 1.0 / std::sqrt(w[0]), frequency = 0.5 * omega / std::numbers::pi;
  const double load = std::max(w[1], w[0] / largest_ratio);  // 1/(r w^2)
  const double ratio = w[0] / load;
  const double damping = 0.5 * w[2] * omega * omega * omega;
  const auto error = [&](const Eigen::Vector3d& slope) { return std::sqrt(slope.dot(c.topLeftCorner(3, 3) * slope)); };
  add_key(finding, "frequency", "_Hz", {frequency}, {error({-0.5 * frequency / w[0], 0.0, 0.0})});
  add_key(finding, "damping_ratio", "", {std::clamp(damping, 0.0, 1.0)},
          {error({-1.5 * damping / w[0], 0.0, 0.5 * omega * omega * omega})});
  add_key(finding, "mass_ratio", "", {std::max(ratio, least_ratio)}, {error({1.0 / load, -ratio / load, 0.0})});
}

}  // namespace

const Candidate structural_resonance{"structural_resonance", no_scan, columns, possible, describe};

}  // namespace stiction::host::effects
