// Force constant, or the scale of the current: where the true one is K, the logged current times the file's K_file is
// the expected force times K_file / K. The column is the expected force, which has none of the current's noise; to
// mass, Coulomb and viscous friction it is their common scale.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::force_constant_mismatch {
namespace {

// A logged force says nothing of the current.
std::vector<double> grid(const SearchContext& context) {
  return context.force_is_current ? std::vector{0.0} : std::vector<double>{};
}
Columns columns(const SearchContext& context, const Motion& motion, double) {
  return {force_along(context.axis, motion)};
}
bool possible(const SearchContext&, double, const Eigen::VectorXd& w) { return w[0] > -0.9; }
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const double constant = context.axis.motor.force_constant / (1.0 + w[0]);
  add_key(context, finding, "force_constant", {constant}, {std::sqrt(c(0, 0)) * constant / (1.0 + w[0])});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .names_coulomb = true}};

}  // namespace stiction::host::effects::force_constant_mismatch
