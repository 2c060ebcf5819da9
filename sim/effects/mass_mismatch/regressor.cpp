// Moving mass: the force is off by (true mass - mass) a.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::mass_mismatch {
namespace {

Columns columns(const SearchContext&, const Motion& motion, double) { return {motion.a}; }
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) { return context.axis.mass + w[0] > 0.0; }
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "mass", {context.axis.mass + w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = no_scan, .columns = columns, .possible = possible, .describe = describe, .of_state = true}};

}  // namespace stiction::host::effects::mass_mismatch
