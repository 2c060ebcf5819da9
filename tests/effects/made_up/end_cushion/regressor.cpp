// The cushion of EndCushion: the place where it begins is scanned over the stroke, the weight is its stiffness.
#include <algorithm>
#include <cmath>

#include "host/diagnose/effect_regressor.hpp"

namespace stiction::host::effects {
namespace {

std::vector<double> grid(const SearchContext& context) {
  std::vector<double> places;
  if (context.stroke() > 0.0)
    for (int k = 1; k < 12; ++k) places.push_back(context.lowest_position + context.stroke() * k / 12.0);
  return places;
}
Columns columns(const SearchContext&, const Motion& motion, double begin) {
  std::vector<double> column(motion.x.size());
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = std::pow(std::max(motion.x[i] - begin, 0.0), 2);
  return {column};
}
bool possible(const SearchContext&, double, const Eigen::VectorXd& w) { return w[0] > 0.0; }
void describe(const SearchContext& context, double begin, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "begin", {begin}, {std::sqrt(c(1, 1))});
  add_key(context, finding, "stiffness", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor end_cushion{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .shape = true}};

}  // namespace stiction::host::effects
