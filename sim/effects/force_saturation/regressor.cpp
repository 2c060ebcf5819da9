// Force that grows less than the current, F = K I_s tanh(I / I_s): for the expected force F the motor needs the current
// of K I_s artanh(F / (K I_s)), which is F and to lowest order F^3 / (3 (K I_s)^2) more. The column is that surplus
// over 1 / (K I_s)^2, so that at the true I_s the weight is 1 / (K I_s)^2 itself.
#include <algorithm>
#include <array>
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::force_saturation {
namespace {

// By the highest expected force over K I_s; more is a motor that has no force left.
constexpr std::array reached{0.15, 0.5, 0.75, 0.9, 0.97};

std::vector<double> grid(const SearchContext& context) {
  std::vector<double> values;
  if (!context.force_is_current || context.highest_force <= 0.0) return values;
  for (const double part : reached) values.push_back(std::pow(part / context.highest_force, 2));
  return values;
}
Columns columns(const SearchContext& context, const Motion& motion, double softness) {
  const double limit = 1.0 / std::sqrt(std::max(softness, 1e-20));
  auto column = force_along(context.axis, motion);
  for (double& f : column) {
    const double part = std::clamp(f / limit, -0.99, 0.99);
    f = limit * limit * limit * (std::atanh(part) - part);
  }
  return {column};
}
// A curve of another bend than the weight's does not describe it; a weak bend is the cube whatever its size.
bool possible(const SearchContext& context, double softness, const Eigen::VectorXd& w) {
  if (w[0] <= 0.0) return false;
  const double part = std::sqrt(w[0]) * context.highest_force;
  const bool weak = std::sqrt(softness) * context.highest_force < 0.2;
  return part < 1.0 && (weak ? part < 0.4 : w[0] / softness > 0.4 && w[0] / softness < 2.5);
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const double current = 1.0 / (std::sqrt(w[0]) * context.axis.motor.force_constant);
  add_key(context, finding, "current", {current}, {0.5 * current / w[0] * std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .at_weight = true}};

}  // namespace stiction::host::effects::force_saturation
