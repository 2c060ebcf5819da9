// What the file's machine needs more force for when the friction of its transmission grows with the load: the plant's
// own law along the motion, weight and load mass among it.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "sim/effects/load_dependent_friction/load_dependent_friction.hpp"

namespace stiction::host::effects::load_dependent_friction {
namespace {

constexpr double step = 0.01;  // of the coefficient; the force is linear in it

// An axis that its motor moves directly carries its load through no teeth.
std::vector<double> grid(const SearchContext& context) {
  return context.axis.transmission ? no_scan(context) : std::vector<double>{};
}
Columns columns(const SearchContext& context, const Motion& motion, double) {
  auto changed = context.axis;
  changed.effects.push_back({std::string(sim::LoadDependentFriction::name), {{"coefficient", {step}}}});
  return {force_change(context.axis, changed, motion, step)};
}
bool possible(const SearchContext&, double, const Eigen::VectorXd& w) {
  return w[0] > 0.0 && w[0] < sim::LoadDependentFriction::parameters.front().range.high;
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "coefficient", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe}};

}  // namespace stiction::host::effects::load_dependent_friction
