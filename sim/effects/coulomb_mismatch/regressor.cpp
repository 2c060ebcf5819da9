// Level of Coulomb friction: what the friction model's force changes by with its level. Near the file's own level the
// change is linear in it. Whether the contact's stiffness stays then (more to overcome) or its distance (more pressed
// on) is not known beforehand, and shows where small reversals are recorded: both are tried.
#include <algorithm>
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::coulomb_mismatch {
namespace {

constexpr double stiffness_stays = 0.0, distance_stays = 1.0;

std::vector<double> grid(const SearchContext& context) {
  if (!contact_of(context.axis)) return {stiffness_stays};
  return {stiffness_stays, distance_stays};
}
Columns columns(const SearchContext& context, const Motion& motion, double contact) {
  const double coulomb = coulomb_of(context.axis), step = std::max(0.02 * coulomb, 0.01);
  auto changed = with_coulomb(context.axis, coulomb + step);
  if (contact == distance_stays) changed = with_contact_distance(changed, contact_of(context.axis)->distance);
  return {force_change(context.axis, changed, motion, step)};
}
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return coulomb_of(context.axis) + w[0] > 0.0;
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "coulomb", {coulomb_of(context.axis) + w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = possible,
                                                 .describe = describe,
                                                 .names_coulomb = true,
                                                 .of_state = true,
                                                 .trials = 2.0}};

}  // namespace stiction::host::effects::coulomb_mismatch
