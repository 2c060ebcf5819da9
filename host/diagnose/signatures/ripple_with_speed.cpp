// A force periodic in position that grows with speed, whatever the current.
#include <fmt/format.h>

#include <cmath>

#include "host/diagnose/candidate.hpp"

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
  return fmt::format("periodic in position with pitch {:.4g} mm, growing with speed: {:.2g} N at {:.3g} m/min",
                     1e3 * pitch, w.head<2>().norm(), 60.0 * context.highest_speed);
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
