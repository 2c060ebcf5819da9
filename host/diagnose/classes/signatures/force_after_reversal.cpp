// A force along the motion that begins at each reversal and dies away with time, whatever the way: friction's contact
// does so with distance. A reversal is where the axis then goes back by more than it hunts: how much that is nobody
// knows, and a slow axis takes long for it, so that two ways are tried.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "host/diagnose/classes/candidate.hpp"
#include "host/log/shown_units.hpp"

namespace stiction::host::signatures::force_after_reversal {
namespace {

constexpr int fewest_reversals = 4;

std::vector<double> grid(const SearchContext& context) {
  return context.reversals < fewest_reversals ? std::vector<double>{} : effects::geometric(5e-3, 0.3, 7);
}
template <int way_back_nm>
Columns columns(const SearchContext&, const Motion& motion, double time) {
  constexpr double way_back = 1e-9 * way_back_nm;
  std::vector<double> column(motion.v.size(), 0.0);
  double turned_at = -std::numeric_limits<double>::infinity();  // s; none yet
  double direction = 0.0, furthest = motion.x.front();
  for (std::size_t i = 0; i < column.size(); ++i) {
    const double ahead = motion.x[i] - furthest;
    if (direction == 0.0 ? std::abs(ahead) > way_back : direction * ahead < -way_back) {
      if (direction != 0.0) turned_at = motion.t[i];
      direction = std::copysign(1.0, ahead);
    }
    if (direction * ahead > 0.0) furthest = motion.x[i];
    column[i] = direction * std::exp(-(motion.t[i] - turned_at) / time);
  }
  return {column};
}
std::string looks_like(const SearchContext& context, double time, const Eigen::VectorXd& w) {
  const auto force = ShownUnits(context.axis.coordinate).force;
  return fmt::format("at reversals: a force of {:.2g} {} {} the motion that decays within {:.2g} ms",
                     std::abs(force(w[0])), force.unit, w[0] < 0.0 ? "along" : "against", 1e3 * time);
}

template <int way_back_nm>
constexpr Candidate going_back{.grid = grid,
                               .columns = columns<way_back_nm>,
                               .possible = effects::any,
                               .describe = nullptr,
                               .shape = true,
                               .looks_like = looks_like};

}  // namespace

// Beyond what a drive hunts at standstill, and beyond what a mount gives way. One that begins at the very turn would
// stand for friction's contact and for a record's delay, too.
const Candidate shape = going_back<2000>;
const Candidate shape_on_way_back = going_back<10000>;

}  // namespace stiction::host::signatures::force_after_reversal
