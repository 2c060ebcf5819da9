// A force that grows with time from each record's start, the same both ways: no friction does.
#include <fmt/format.h>

#include "host/diagnose/classes/candidate.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures::drifting_force {
namespace {

Columns columns(const SearchContext& context, const Motion& motion, double) {
  std::vector<double> column(motion.t.size());
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = -motion.t[i] / context.duration;
  return {column};
}
std::string looks_like(const SearchContext& context, double, const Eigen::VectorXd& w) {
  const auto force = ShownUnits(context.axis.coordinate).force;
  return fmt::format("drifting with time, equal in both directions: {:.2g} {} after {:.3g} s", force(w[0]), force.unit,
                     context.duration);
}

}  // namespace

const Candidate shape{.grid = effects::no_scan,
                      .columns = columns,
                      .possible = effects::any,
                      .describe = nullptr,
                      .looks_like = looks_like};

}  // namespace stiction::host::signatures::drifting_force
