// Friction that differs between the directions: half differences of Coulomb and viscous friction. The first is a
// constant force while the axis moves.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::friction_asymmetry {
namespace {

Columns columns(const SearchContext& context, const Motion& motion, double) {
  auto moving = contact_level(context.axis, motion);
  std::vector<double> speed(motion.v.size());
  for (std::size_t i = 0; i < speed.size(); ++i) {
    moving[i] = std::abs(moving[i]);
    speed[i] = std::abs(motion.v[i]);
  }
  return {moving, speed};
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "coulomb", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "viscous", {w[1]}, {std::sqrt(c(1, 1))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = no_scan, .columns = columns, .possible = any, .describe = describe, .names_constant = true}};

}  // namespace stiction::host::effects::friction_asymmetry
