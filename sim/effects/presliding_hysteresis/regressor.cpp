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
// Of the file's law, drawn out.
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "distance", {distance_with(context, w[0])}, {std::sqrt(c(0, 0))});
}
// Of any shape, which begins as that of the file's curve; without one, exponential.
void describe_freely(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
                     Finding& finding) {
  const double distance = distance_with(context, w[0]), error = std::sqrt(c(0, 0));
  const auto file = contact_of(context.axis);
  const double sharpness = file ? file->stiffness * file->distance : coulomb_of(context.axis) * std::numbers::ln10;
  add_key(context, finding, "stiffness", {sharpness / distance}, {sharpness * error / (distance * distance)});
  add_key(context, finding, "distance", {distance}, {error});
}

// Of a share of the friction, whatever the distance: a seal beside a guide, a part of the surfaces. At unit weight all
// of it has that distance.
namespace of_share {

std::vector<double> grid(const SearchContext& context) {
  const double file = distance_of(context);
  if (!(coulomb_of(context.axis) > 0.0) || context.reversals < least_reversals) return {};
  if (!(file > 0.0)) return geometric(1e-6, longest, 8);
  std::vector<double> distances;
  for (const double factor : {0.125, 0.25, 0.5, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0})
    if (factor * file > 1e-8 && factor * file < longest) distances.push_back(factor * file);
  return distances;
}
Columns columns(const SearchContext& context, const Motion& motion, double distance) {
  return {force_change(context.axis, with_contact_distance(context.axis, distance), motion, 1.0)};
}
bool possible(const SearchContext&, double, const Eigen::VectorXd& w) {
  constexpr double most = 0.9;  // more is all of it
  return w[0] > 0.0 && w[0] < most;
}
void describe(const SearchContext& context, double distance, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "distance", {distance}, {std::sqrt(c(1, 1))});
  add_key(context, finding, "share", {w[0]}, {std::sqrt(c(0, 0))});
}
const Candidate force{.grid = grid, .columns = columns, .possible = possible, .describe = describe, .shape = true};

}  // namespace of_share
}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = possible,
                                                 .describe = describe,
                                                 .describe_freely = describe_freely,
                                                 .at_weight = true},
                                       .other_forces = {&of_share::force, 1}};

}  // namespace stiction::host::effects::presliding_hysteresis
