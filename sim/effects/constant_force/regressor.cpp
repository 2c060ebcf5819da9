// Gravity, an unbalanced weight, an offset of the current: on the carriage in +x, so the motor needs less.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::constant_force {
namespace {

Columns columns(const SearchContext&, const Motion& motion, double) {
  return {std::vector<double>(motion.x.size(), -1.0)};
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "force", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = no_scan,
                                                 .columns = columns,
                                                 .possible = any,
                                                 .describe = describe,
                                                 .names_constant = true,
                                                 .of_state = true}};

}  // namespace stiction::host::effects::constant_force
