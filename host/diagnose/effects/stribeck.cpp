// Friction that falls with speed near standstill: break_away exp(-(v / velocity)^2) times the contact's direction.
#include <cmath>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"
#include "host/identify/contact.hpp"

namespace stiction::host::effects {
namespace {

std::vector<double> grid(const Scene& scene) {
  return geometric(0.003 * scene.highest_speed, 0.3 * scene.highest_speed, 14);
}
Columns columns(const Scene& scene, const Motion& motion, double velocity) {
  return {stribeck_column(motion, contact_level(scene.axis, motion), velocity)};
}
bool possible(const Scene&, double, const Eigen::VectorXd& w) { return w[0] > 0.0; }
void describe(const Scene&, double velocity, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  add_key(finding, "break_away", "_N", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(finding, "velocity", "_m_per_s", {velocity}, {std::sqrt(c(1, 1))});
}

}  // namespace

const Candidate stribeck{.name = "stribeck",
                         .grid = grid,
                         .columns = columns,
                         .possible = possible,
                         .describe = describe,
                         .nonlinear = true};

}  // namespace stiction::host::effects
