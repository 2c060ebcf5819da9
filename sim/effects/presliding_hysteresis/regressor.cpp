// Spring-like displacement before sliding: the file's contact, drawn out or shortened to another distance to 90 % of
// its level; for a file without one, a contact in place of sgn(v). The scanned value is how much longer the distance
// is: with the level held, the weight at the true one is that length itself.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::presliding_hysteresis {
namespace {

constexpr int least_reversals = 2;  // one each way
constexpr double longest = 3e-3;    // m

// 0 for friction that follows the speed alone.
double distance_of(const SearchContext& context) {
  const auto contact = contact_of(context.axis);
  return contact ? contact->distance : 0.0;
}

double distance_with(const SearchContext& context, double longer) {
  const double file = distance_of(context);
  return std::max(file + longer, std::max(0.02 * file, 1e-8));
}

std::vector<double> grid(const SearchContext& context) {
  const double file = distance_of(context);
  if (!(coulomb_of(context.axis) > 0.0) || context.reversals < least_reversals) return {};
  if (!(file > 0.0)) return geometric(1e-6, 3e-3, 14);
  std::vector<double> longer;
  for (const double share : {-0.75, -0.5, -0.25, -0.1, -0.03, 0.03, 0.08, 0.2}) longer.push_back(share * file);
  for (double more = 0.4 * file; more < longest; more *= 1.6) longer.push_back(more);
  return longer;
}
Columns columns(const SearchContext& context, const Motion& motion, double longer) {
  return {
      force_change(context.axis, with_contact_distance(context.axis, distance_with(context, longer)), motion, longer)};
}
// The column holds near the distance for which it was made.
bool possible(const SearchContext&, double longer, const Eigen::VectorXd& w) {
  return w[0] / longer > 0.4 && w[0] / longer < 2.5;
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const double distance = distance_with(context, w[0]), error = std::sqrt(c(0, 0));
  // Of the same shape as the file's curve; without one, exponential.
  const auto file = contact_of(context.axis);
  const double sharpness = file ? file->stiffness * file->distance : coulomb_of(context.axis) * std::numbers::ln10;
  add_key(context, finding, "stiffness", {sharpness / distance}, {sharpness * error / (distance * distance)});
  add_key(context, finding, "distance", {distance}, {error});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .at_weight = true}};

}  // namespace stiction::host::effects::presliding_hysteresis
