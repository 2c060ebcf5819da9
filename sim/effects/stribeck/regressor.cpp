// Friction that falls with speed near standstill: break_away exp(-(v / velocity)^2) times the contact's direction.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/identify/contact.hpp"

namespace stiction::host::effects::stribeck {
namespace {

std::vector<double> grid(const SearchContext& context) {
  return geometric(0.003 * context.highest_speed, 0.3 * context.highest_speed, 14);
}
Columns columns(const SearchContext& context, const Motion& motion, double velocity) {
  return {stribeck_column(motion, contact_level(context.axis, motion), velocity)};
}
bool possible(const SearchContext&, double, const Eigen::VectorXd& w) { return w[0] > 0.0; }
void describe(const SearchContext& context, double velocity, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "break_away", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "velocity", {velocity}, {std::sqrt(c(1, 1))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .shape = true}};

}  // namespace stiction::host::effects::stribeck
