// Friction that rises less (or more) than linearly: force (1 - exp(-|v| / velocity)) sgn v beside the model's own.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"

namespace stiction::host::effects::viscous_nonlinear {
namespace {

std::vector<double> grid(const SearchContext& context) {
  return geometric(0.02 * context.highest_speed, 0.7 * context.highest_speed, 12);
}
Columns columns(const SearchContext&, const Motion& motion, double velocity) {
  std::vector<double> column(motion.v.size());
  for (std::size_t i = 0; i < column.size(); ++i)
    column[i] = std::copysign(sim::ViscousNonlinear::risen(std::abs(motion.v[i]) / velocity), motion.v[i]);
  return {column};
}
void describe(const SearchContext& context, double velocity, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "force", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "velocity", {velocity}, {std::sqrt(c(1, 1))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = any, .describe = describe, .shape = true}};

}  // namespace stiction::host::effects::viscous_nonlinear
