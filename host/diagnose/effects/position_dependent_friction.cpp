// Friction whose level varies along the stroke: at knots evenly over it a level each, linear between, times the
// contact's direction. How many knots is what the scan finds: as few as the data ask for. Their common level belongs to
// the profile; a change of the level alone is a Coulomb mismatch, which needs one column for it.
#include <algorithm>
#include <cmath>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

std::vector<double> grid(const Scene& scene) {
  return scene.stroke() > 0.0 ? std::vector{2.0, 3.0, 4.0, 6.0, 9.0} : std::vector<double>{};
}
double spacing(const Scene& scene, double knots) { return scene.stroke() / (knots - 1.0); }

Columns columns(const Scene& scene, const Motion& motion, double knots) {
  const auto level = contact_level(scene.axis, motion);
  Columns hats(static_cast<std::size_t>(knots), std::vector<double>(level.size(), 0.0));
  for (std::size_t i = 0; i < level.size(); ++i) {
    const double place = std::clamp((motion.x[i] - scene.lowest_position) / spacing(scene, knots), 0.0, knots - 1.0);
    const auto k = std::min(static_cast<std::size_t>(place), hats.size() - 2);
    const double share = place - static_cast<double>(k);
    hats[k][i] = (1.0 - share) * level[i];
    hats[k + 1][i] = share * level[i];
  }
  return hats;
}
void describe(const Scene& scene, double knots, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  std::vector<double> position, force, error;
  for (Eigen::Index k = 0; k < w.size(); ++k) {
    position.push_back(scene.lowest_position + spacing(scene, knots) * static_cast<double>(k));
    force.push_back(w[k]);
    error.push_back(std::sqrt(c(k, k)));
  }
  add_key(finding, "position", "_m", position, {});
  add_key(finding, "force", "_N", force, error);
}

}  // namespace

const Candidate position_dependent_friction{.name = "position_dependent_friction",
                                            .grid = grid,
                                            .columns = columns,
                                            .possible = any,
                                            .describe = describe,
                                            .names_coulomb = true};

}  // namespace stiction::host::effects
