// Slope of viscous friction.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::viscous_mismatch {
namespace {

Columns columns(const SearchContext& context, const Motion& motion, double) {
  return {force_change(context.axis, with_viscous(context.axis, viscous_of(context.axis) + 1.0), motion, 1.0)};
}
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return viscous_of(context.axis) + w[0] >= 0.0;
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "viscous", {viscous_of(context.axis) + w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = no_scan, .columns = columns, .possible = possible, .describe = describe, .of_state = true}};

}  // namespace stiction::host::effects::viscous_mismatch
