// Friction level that changes with the time since the record's start, or since that of the session: change (1 - exp(-t
// / time_constant)) times the contact's direction.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::thermal_drift {
namespace {

// Shorter than a twentieth of a record it is an event at its start, longer than twice it is a straight line.
std::vector<double> grid(const SearchContext& context) {
  return geometric(0.05 * context.duration, 2.0 * context.duration, 9);
}
Columns columns(const SearchContext& context, const Motion& motion, double time_constant) {
  auto column = contact_level(context.axis, motion);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] *= -std::expm1(-motion.t[i] / time_constant);
  return {column};
}
void describe(const SearchContext& context, double time_constant, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "change", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "time_constant", {time_constant}, {std::sqrt(c(1, 1))});
}

// Through all records.
namespace session {

std::vector<double> grid(const SearchContext& context) {
  const double end = context.session.end;
  return end > 0.0 ? geometric(0.05 * end, 2.0 * end, 9) : std::vector<double>{};
}
Columns columns(const SearchContext& context, const Motion& motion, double time_constant) {
  auto column = contact_level(context.axis, motion);
  const double began = context.session.begin_of(motion.source);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] *= -std::expm1(-(motion.t[i] + began) / time_constant);
  return {column};
}
// The machine as the training records left it.
void describe(const SearchContext& context, double time_constant, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  thermal_drift::describe(context, time_constant, w, c, finding);
  add_key(context, finding, "elapsed", {context.session.end}, {});
}
const Candidate force{.grid = grid,
                      .columns = columns,
                      .possible = any,
                      .describe = describe,
                      .shape = true,
                      .names_coulomb = true,
                      .through_session = true};

}  // namespace session
}  // namespace

extern const EffectRegressor regressor{
    .force =
        {.grid = grid, .columns = columns, .possible = any, .describe = describe, .shape = true, .names_coulomb = true},
    .other_forces = {&session::force, 1}};

}  // namespace stiction::host::effects::thermal_drift
