// Friction that follows the speed with a first-order lag: g(w) - g(v) over the time, g the file's friction as far as it
// depends on the speed. The scanned time is the place of the slope: at the true one the weight is the time itself. Of
// viscous friction alone it is for short times - viscous time dv/dt, a mass that is missing.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "sim/effects/friction_lag/friction_lag.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host::effects::friction_lag {
namespace {

// A slope a factor from its place fits worse than the mass that it is confused with.
std::vector<double> grid(const SearchContext&) { return geometric(1e-3, 80e-3, 12); }
Columns columns(const SearchContext& context, const Motion& motion, double time) {
  const auto friction = sim::steady_friction(context.axis.friction);
  const auto direction = contact_level(context.axis, motion);
  std::vector<double> column(motion.v.size());
  const double share = motion.period / (2.0 * time + motion.period);  // trapezoidal rule
  double followed = motion.v.front();
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (i > 0) followed += share * (motion.v[i] + motion.v[i - 1] - 2.0 * followed);
    column[i] = (friction(followed, direction[i]) - friction(motion.v[i], direction[i])) / time;
  }
  return {column};
}
// Slopes far from the weight do not describe it.
bool possible(const SearchContext&, double time, const Eigen::VectorXd& w) {
  return w[0] > 0.4 * time && w[0] < 2.5 * time;
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "time", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .at_weight = true}};

}  // namespace stiction::host::effects::friction_lag
