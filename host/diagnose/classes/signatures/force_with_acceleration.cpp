// A force that grows with acceleration, the same way for both signs of it: no mass, no force constant makes one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/diagnose/classes/candidate.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures::force_with_acceleration {
namespace {

Columns columns(const SearchContext&, const Motion& motion, double) {
  std::vector<double> column(motion.a.size());
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = -std::abs(motion.a[i]);
  return {column};
}
std::string looks_like(const SearchContext& context, double, const Eigen::VectorXd& w) {
  const ShownUnits own(context.axis.coordinate);
  return fmt::format("growing with acceleration, with equal sign for both directions of it: {:.2g} {} at 1 {}",
                     own.force(w[0]) / own.acceleration.factor, own.force.unit, own.acceleration.unit);
}

}  // namespace

const Candidate shape{.grid = effects::no_scan,
                      .columns = columns,
                      .possible = effects::any,
                      .describe = nullptr,
                      .looks_like = looks_like};

}  // namespace stiction::host::signatures::force_with_acceleration
