// A force periodic in position that grows with speed, whatever the current.
#include <fmt/format.h>

#include <cmath>

#include "host/diagnose/classes/candidate.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures::ripple_with_speed {
namespace {

const LineScan& scan(const SearchContext& context) { return context.by_speed; }
std::vector<double> grid(const SearchContext& context) { return scan(context).periods; }
Columns columns(const SearchContext& context, const Motion& motion, double pitch) {
  std::vector<double> size(motion.v.size());
  for (std::size_t i = 0; i < size.size(); ++i) size[i] = std::abs(motion.v[i]) / context.highest_speed;
  return effects::waves_over_position(motion, pitch, size);
}
std::string looks_like(const SearchContext& context, double pitch, const Eigen::VectorXd& w) {
  const ShownUnits own(context.axis.coordinate);
  return fmt::format("periodic in position with pitch {:.4g} {}, growing with speed: {:.2g} {} at {:.3g} {}",
                     own.position(pitch), own.position.unit, own.force(w.head<2>().norm()), own.force.unit,
                     own.feed(context.highest_speed), own.feed.unit);
}

}  // namespace

const Candidate shape{.grid = grid,
                      .columns = columns,
                      .possible = effects::any,
                      .describe = nullptr,
                      .shape = true,
                      .periodic = true,
                      .scan = scan,
                      .looks_like = looks_like};

}  // namespace stiction::host::signatures::ripple_with_speed
