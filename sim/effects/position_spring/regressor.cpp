// Force proportional to position, -stiffness (x - neutral) on the carriage: cable carrier, bellows, hose.
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::position_spring {
namespace {

double middle(const SearchContext& context) { return 0.5 * (context.lowest_position + context.highest_position); }

std::vector<double> grid(const SearchContext& context) {
  return context.stroke() > 0.0 ? std::vector{0.0} : std::vector<double>{};
}
Columns columns(const SearchContext& context, const Motion& motion, double) {
  auto way = motion.x;
  for (double& x : way) x -= middle(context);
  return {way, std::vector<double>(motion.x.size(), -1.0)};
}
// A spring that is at rest far beyond the stroke is a constant force.
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) {
  constexpr double strokes = 2.5;
  return std::abs(w[1]) < strokes * context.stroke() * std::abs(w[0]);
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  // k (x - neutral) = w0 (x - middle) - w1
  const double shift = w[1] / w[0];
  const double error =
      std::sqrt(std::max(c(1, 1) + shift * shift * c(0, 0) - 2.0 * shift * c(0, 1), 0.0)) / std::abs(w[0]);
  add_key(context, finding, "stiffness", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "neutral", {middle(context) + shift}, {error});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe}};

}  // namespace stiction::host::effects::position_spring
