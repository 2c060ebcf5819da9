// The other axis' acceleration as a force on the carriage, mass a_other in +x: the motor needs that much less.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::cross_axis_coupling {
namespace {

std::vector<double> grid(const SearchContext& context) {
  return context.other_axis ? std::vector{0.0} : std::vector<double>{};
}
Columns columns(const SearchContext&, const Motion& motion, double) {
  std::vector<double> column(motion.x.size());  // zero for a held-out log without the other axis
  for (std::size_t i = 0; i < motion.other_a.size(); ++i) column[i] = -motion.other_a[i];
  return {column};
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "mass", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = any, .describe = describe}};

}  // namespace stiction::host::effects::cross_axis_coupling
