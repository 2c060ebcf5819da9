// A push at one place of the stroke, the same in both directions: a Gaussian of one of two widths.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "host/diagnose/classes/candidate.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures::localised_force {
namespace {

// Places along the stroke, a standard deviation apart: narrow ones, then wide ones.
constexpr int narrow = 40, wide = 12;

struct Place {
  double at, width;  // m; width: standard deviation
};
Place place_of(const SearchContext& context, double number) {
  const bool is_wide = number >= narrow;
  const double step = context.stroke() / (is_wide ? wide : narrow);
  return {context.lowest_position + (number - (is_wide ? narrow : 0) + 0.5) * step, step};
}
std::vector<double> grid(const SearchContext& context) {
  std::vector<double> numbers;
  if (context.stroke() > 0.0)
    for (int k = 0; k < narrow + wide; ++k) numbers.push_back(k);
  return numbers;
}
Columns columns(const SearchContext& context, const Motion& motion, double number) {
  const auto place = place_of(context, number);
  std::vector<double> column(motion.x.size());
  for (std::size_t i = 0; i < column.size(); ++i) {
    const double off = (motion.x[i] - place.at) / place.width;
    column[i] = -std::exp(-0.5 * off * off);
  }
  return {column};
}
std::string looks_like(const SearchContext& context, double number, const Eigen::VectorXd& w) {
  const auto place = place_of(context, number);
  const ShownUnits own(context.axis.coordinate);
  return fmt::format("localised at {:.4g} {}: a force of {:.2g} {}, equal in both directions, over about {:.2g} {}",
                     own.position(place.at), own.position.unit, own.force(w[0]), own.force.unit,
                     2.0 * own.position(place.width), own.position.unit);
}

}  // namespace

const Candidate shape{.grid = grid,
                      .columns = columns,
                      .possible = effects::any,
                      .describe = nullptr,
                      .trials = narrow + wide,
                      .looks_like = looks_like};

}  // namespace stiction::host::signatures::localised_force
