// Of a shaft with the stiffness k the load is behind its motor by force / k: as much again as the file says, times
// (k of the file / k) - 1.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::shaft_stiffness {
namespace {

double stiffness(const machine::AxisModel& axis) { return *axis.transmission->stiffness; }

std::vector<double> grid(const machine::AxisModel&) { return {0.0}; }
std::vector<std::vector<double>> columns(const ShaftRun& run, double) {
  auto twist = run.force;
  for (double& value : twist) value /= -stiffness(run.axis);
  return {twist};
}
bool possible(const machine::AxisModel&, double, const Eigen::VectorXd& w) { return w[0] > -1.0; }
void describe(const machine::AxisModel& axis, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const double found = stiffness(axis) / (1.0 + w[0]);
  add_key(axis, finding, "stiffness", found, found / (1.0 + w[0]) * std::sqrt(c(0, 0)));
}

}  // namespace

extern const EffectRegressor regressor{
    .encoders = {.grid = grid, .columns = columns, .possible = possible, .describe = describe}};

}  // namespace stiction::host::effects::shaft_stiffness
