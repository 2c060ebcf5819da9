// Lost motion between motor and measured position. The motor crosses the gap while the measured position stands, and
// how fast it does is the drive's answer to what it does not see: a velocity loop of 40 Hz is about as fast as a gap of
// 2 um. So the column is what the set-points leave in simulation with a gap, and a log without set-points has none. A
// gap below the position controller's increment shows mostly in how the axis hunts, which noise makes another in every
// run: the simulation is under forces like the record's, and what several such runs have in common is the column.
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "sim/effects/backlash/backlash.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::host::effects::backlash {
namespace {

// m. By many increments a gap shows however the axis hunts: one run tells that there is one, and its width is found
// with columns of its own.
constexpr double near = 1e-6, far = 16e-6;
// At its far side a wide gap closes with a blow of several times Coulomb friction (circles at 8 m/min: 10 um 1.5, 40 um
// 4 times); without one it is not tried: it costs a run.
constexpr double widest = 64e-6, blow = 2.0;
// m, the increment by which the axes of these widths are controlled. A rotary axis has widths of as many of its own: a
// micrometre on the circle that it runs on is no size of its own, and may be a hundredth of a count.
constexpr double usual_increment = 1e-6;
double scale_of(const machine::AxisModel& axis) {
  if (!axis.coordinate.rotary()) return 1.0;
  const double seen = std::max(axis.encoder.increment, axis.position_controller.increment);
  return seen > 0.0 ? seen / usual_increment : axis.coordinate.radius;
}

// A file whose friction has no presliding of its own leaves one in the residual, over micrometres as a small gap does.
std::vector<double> grid(const SearchContext& context) {
  if (!context.response) return {};
  const double scale = scale_of(context.axis);
  if (!contact_of(context.axis)) return {scale * widest};
  if (context.highest_residual > blow * coulomb_of(context.axis)) return {scale * near, scale * far, scale * widest};
  return {scale * near, scale * far};
}

Columns columns(const SearchContext& context, const Motion& motion, double width) {
  const double scale = scale_of(context.axis);
  const std::size_t most_runs = width == scale * near  ? 2
                                : width == scale * far ? 1
                                                       : std::numeric_limits<std::size_t>::max();
  auto column = context.response(motion, sim::effect_of<sim::Backlash>({.width = std::abs(width)}), most_runs);
  for (double& force : column) force /= std::abs(width);
  return {column};
}
// A width beyond the next value of the grid is described by that one; below the first one's reach there is none,
// however often it is linearised anew: the dither of a loop on coarse counts is alike in simulation and record and
// shrinks it.
bool possible(const SearchContext& context, double width, const Eigen::VectorXd& w) {
  constexpr double reach = 16.0;
  return w[0] > width / reach && w[0] > scale_of(context.axis) * near / reach && w[0] < reach * width;
}
bool coarse(const SearchContext& context, double width) { return width >= scale_of(context.axis) * far; }
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "width", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = possible,
                                                 .describe = describe,
                                                 .at_weight = true,
                                                 .replays = true,
                                                 .coarse = coarse}};

}  // namespace stiction::host::effects::backlash
