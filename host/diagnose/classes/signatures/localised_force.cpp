// A push at one place of the stroke, the same in both directions: a triangle over position.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/diagnose/classes/candidate.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures::localised_force {
namespace {

const PlaceScan& places(const SearchContext& context) { return context.pushes; }
const Place& place_of(const SearchContext& context, double number) { return places(context).at(number); }
std::vector<double> grid(const SearchContext&) { return {}; }
Columns columns(const SearchContext& context, const Motion& motion, double number) {
  const auto& place = place_of(context, number);
  std::vector<double> column(motion.x.size());
  for (std::size_t i = 0; i < column.size(); ++i) {
    column[i] = -std::max(1.0 - std::abs(motion.x[i] - place.at) / place.foot, 0.0);
  }
  return {column};
}
std::string looks_like(const SearchContext& context, double number, const Eigen::VectorXd& w) {
  const auto& place = place_of(context, number);
  const ShownUnits own(context.axis.coordinate);
  return fmt::format("localised at {:.4g} {}: a force of {:.2g} {}, equal in both directions, over about {:.2g} {}",
                     own.position(place.at), own.position.unit, own.force(w[0]), own.force.unit,
                     own.position(place.foot), own.position.unit);
}

}  // namespace

const Candidate shape{.grid = grid,
                      .columns = columns,
                      .possible = effects::any,
                      .describe = nullptr,
                      .places = places,
                      .looks_like = looks_like};

}  // namespace stiction::host::signatures::localised_force
