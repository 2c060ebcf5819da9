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
#include "sim/effects/effects.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"

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

// In front of a heavy body, which has the friction: while the motor crosses the gap nothing drives the slide, which
// sticks or slows down, and the drive waits for it. What shows is the motor's acceleration against it, of the share of
// the mass that is in front.
namespace heavy {

// Of drives whose motor is matched to its load; columns hardly tell the shares apart.
constexpr double usual_ratio = 0.5, ratio_error = 0.2;
constexpr double narrow = 3e-6, wide = 24e-6;  // m
// What two runs have in common: of one alone, whose motor crosses at instants of its own, a gap came out a third as
// wide.
constexpr std::size_t runs = 2;

sim::Backlash::Parameters gap(double width) { return {.width = std::abs(width), .mass_ratio = usual_ratio}; }

std::vector<double> grid(const SearchContext& context) {
  if (!context.response || context.axis.elastic()) return {};
  if (!sim::effects_of<sim::StructuralResonance>(context.axis).empty()) return {};
  const double scale = scale_of(context.axis);
  return {scale * narrow, scale * wide};
}
Columns columns(const SearchContext& context, const Motion& motion, double width) {
  auto column = context.response(motion, sim::effect_of<sim::Backlash>(gap(width)), runs);
  // Contacts alone leave a force, too; it is no gap's.
  const auto closed = context.response(motion, sim::effect_of<sim::Backlash>(gap(0.0)), runs);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - closed[i]) / std::abs(width);
  return {column};
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  // The force is that of the share in front: the width is known no better than this.
  add_key(context, finding, "width", {w[0]},
          {std::hypot(std::sqrt(c(0, 0)), w[0] * ratio_error / (1.0 - usual_ratio))});
  add_key(context, finding, "mass_ratio", {usual_ratio}, {ratio_error});
}
const Candidate force{.grid = grid,
                      .columns = columns,
                      .possible = possible,
                      .describe = describe,
                      .at_weight = true,
                      .replays = true,
                      .coarse = coarse,
                      .trials = 2.0,
                      .two_bodies = true};

}  // namespace heavy
}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = possible,
                                                 .describe = describe,
                                                 .at_weight = true,
                                                 .replays = true,
                                                 .coarse = coarse},
                                       .other_forces = {&heavy::force, 1}};

}  // namespace stiction::host::effects::backlash
