// Friction whose level varies along the stroke: at knots a level each, linear between, times the contact's direction.
// Either they stand over the whole stroke, where their common level belongs to the profile (a change of the level alone
// is a Coulomb mismatch, which needs one column for it): how many there are, and whether they stand closer at one end,
// is what the scan finds. Or they stand at one place, with no change beside it: a tight spot.
#include <algorithm>
#include <array>
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::position_dependent_friction {
namespace {

// Knot k of `count` stands at (k / (count - 1))^warp of the stroke.
struct Shape {
  int count;
  double warp;
};
constexpr std::array<Shape, 9> shapes{
    {{2, 1.0}, {3, 1.0}, {3, 0.55}, {3, 1.7}, {4, 1.0}, {4, 0.7}, {4, 1.4}, {6, 1.0}, {9, 1.0}}};

// The scanned value is the index of a shape.
std::vector<double> grid(const SearchContext& context) {
  std::vector<double> indices;
  if (context.stroke() > 0.0)
    for (std::size_t i = 0; i < shapes.size(); ++i) indices.push_back(static_cast<double>(i));
  return indices;
}
const PlaceScan& spots(const SearchContext& context) { return context.tight_spots; }
constexpr int knots_of_a_spot = 5;  // the outer two without a level

// Where the knots stand; `index` of a shape, or of a tight spot.
std::vector<double> knots_of(const SearchContext& context, double index) {
  if (PlaceScan::is_place(index)) {
    const auto& spot = spots(context).at(index);
    std::vector<double> places;
    for (int k = 0; k < knots_of_a_spot; ++k)
      places.push_back(spot.at + spot.foot * (2.0 * k / (knots_of_a_spot - 1) - 1.0));
    return places;
  }
  const auto [count, warp] = shapes[static_cast<std::size_t>(index)];
  std::vector<double> places;
  for (int k = 0; k < count; ++k)
    places.push_back(context.lowest_position + context.stroke() * std::pow(static_cast<double>(k) / (count - 1), warp));
  return places;
}

Columns columns(const SearchContext& context, const Motion& motion, double index) {
  const auto level = contact_level(context.axis, motion);
  const auto at = knots_of(context, index);
  Columns hats(at.size(), std::vector<double>(level.size(), 0.0));
  for (std::size_t i = 0; i < level.size(); ++i) {
    const auto next = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), motion.x[i]) - at.begin());
    const std::size_t k = std::clamp<std::size_t>(next, 1, at.size() - 1);
    const double share = std::clamp((motion.x[i] - at[k - 1]) / (at[k] - at[k - 1]), 0.0, 1.0);
    hats[k - 1][i] = (1.0 - share) * level[i];
    hats[k][i] = share * level[i];
  }
  if (PlaceScan::is_place(index)) hats = {hats.begin() + 1, hats.end() - 1};
  return hats;
}
void describe(const SearchContext& context, double index, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  std::vector<double> force(w.data(), w.data() + w.size()), error;
  for (Eigen::Index k = 0; k < w.size(); ++k) error.push_back(std::sqrt(c(k, k)));
  if (PlaceScan::is_place(index))
    for (auto* values : {&force, &error}) {
      values->insert(values->begin(), 0.0);
      values->push_back(0.0);
    }
  add_key(context, finding, "position", knots_of(context, index), {});
  add_key(context, finding, "force", std::move(force), std::move(error));
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = any,
                                                 .describe = describe,
                                                 .names_coulomb = true,
                                                 .along_stroke = true,
                                                 .trials = 3.0,
                                                 .places = spots}};

}  // namespace stiction::host::effects::position_dependent_friction
