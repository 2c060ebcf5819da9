// Level of Coulomb friction: what the friction model's force changes by with its level. Near the file's own level the
// change is linear in it; the contact's stiffness stays.
#include <algorithm>
#include <cmath>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

double step_of(double coulomb) { return std::max(0.02 * coulomb, 0.01); }

std::vector<double> grid(const Scene& scene) {
  return coulomb_of(scene.axis) ? std::vector{0.0} : std::vector<double>{};
}
Columns columns(const Scene& scene, const Motion& motion, double) {
  const double coulomb = *coulomb_of(scene.axis), step = step_of(coulomb);
  return {force_change(scene.axis, with_coulomb(scene.axis, coulomb + step), motion, step)};
}
bool possible(const Scene& scene, double, const Eigen::VectorXd& w) { return *coulomb_of(scene.axis) + w[0] > 0.0; }
void describe(const Scene& scene, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  add_key(finding, "coulomb", "_N", {*coulomb_of(scene.axis) + w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

const Candidate coulomb_mismatch{.name = "coulomb_mismatch",
                                 .grid = grid,
                                 .columns = columns,
                                 .possible = possible,
                                 .describe = describe,
                                 .names_coulomb = true};

}  // namespace stiction::host::effects
