// Spring-like displacement before sliding: the contact's level, driven by the position, with another length than the
// file's. Of a contact s' = (v - |v| s) / length that starts unloaded, 90 % of the level are reached after ln(10)
// lengths.
#include <cmath>
#include <numbers>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"
#include "host/identify/contact.hpp"

namespace stiction::host::effects {
namespace {

// Seven large reversals do not identify a hysteresis: sgn(v) and a contact then fit one another.
constexpr int least_reversals = 10;

std::vector<double> grid(const Scene& scene) {
  if (!coulomb_of(scene.axis) || scene.reversals < least_reversals) return {};
  return geometric(1e-6, 3e-3, 20);
}
Columns columns(const Scene& scene, const Motion& motion, double distance) {
  auto column = contact_of(motion, {std::numbers::ln10 / distance, 1.0, 1e-3}).level;
  const auto file = contact_level(scene.axis, motion);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] -= file[i];
  return {column};
}
// The whole Coulomb level presliding, or a good part of it.
bool possible(const Scene& scene, double, const Eigen::VectorXd& w) {
  return w[0] > 0.1 * *coulomb_of(scene.axis) && w[0] < 2.0 * *coulomb_of(scene.axis);
}
void describe(const Scene& scene, double distance, const Eigen::VectorXd&, const Eigen::MatrixXd& c, Finding& finding) {
  const double error = std::sqrt(c(1, 1));
  const double stiffness = *coulomb_of(scene.axis) * std::numbers::ln10 / distance;
  add_key(finding, "stiffness", "_N_per_m", {stiffness}, {stiffness * error / distance});
  add_key(finding, "distance", "_m", {distance}, {error});
}

}  // namespace

const Candidate presliding_hysteresis{.name = "presliding_hysteresis",
                                      .grid = grid,
                                      .columns = columns,
                                      .possible = possible,
                                      .describe = describe,
                                      .nonlinear = true};

}  // namespace stiction::host::effects
