// Lost motion between motor and measured position. The motor crosses the gap while the measured position stands, and
// how fast it does is the drive's answer to what it does not see: a velocity loop of 40 Hz is about as fast as a gap of
// 2 um. So the column is what the set-points leave in simulation with a gap, and a log without set-points has none. A
// gap below the position controller's increment shows mostly in how the axis hunts, which noise makes another in every
// run: the simulation is under forces like the record's, and what several such runs have in common is the column.
#include <algorithm>
#include <array>
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

// In front of a heavy body, which has the friction: at the instants at which the force through the contact turns, the
// motor crosses the gap by itself, and along the measured motion of the slide its acceleration ahead of it is all that
// shows. Which instants those are depends on how the mass is shared, sharply: with 50 % of it behind the gap in place
// of 60 % two columns had a correlation of 0.33, with three times the width one of 0.87. So the share is scanned.
namespace heavy {

constexpr double least_behind = 0.1, most_behind = 0.95;  // of the mass; with more or less one of the two hardly counts

// m, between the contacts, of the motor ahead of the slide: free under `force` (N, of each sample, `period` s apart),
// which the contact would carry; a blow against a contact ends the motion. `reduced`: mass of both, kg.
std::vector<double> lead_of(const std::vector<double>& force, double period, double reduced, double width) {
  constexpr int parts = 8;  // of a sample
  const double step = period / parts, most = 0.5 * width;
  std::vector<double> lead(force.size());
  double at = std::copysign(most, force.front()), rate = 0.0;
  lead.front() = at;
  for (std::size_t i = 1; i < force.size(); ++i) {
    for (int part = 0; part < parts; ++part) {
      const double now = force[i - 1] + (force[i] - force[i - 1]) * (part + 0.5) / parts;
      rate += step * now / reduced;
      const double there = at + step * rate;
      at = std::clamp(there, -most, most);
      if (at != there) rate = 0.0;
    }
    lead[i] = at;
  }
  return lead;
}

// m, that the axis goes in so many half milliseconds from rest under the largest force of the records: the size of a
// gap is seen by how long it takes to cross. Columns tell widths from an eighth of their own to eight times as much.
template <int half_milliseconds>
double width_of(const SearchContext& context) {
  constexpr double time = 0.5e-3 * half_milliseconds;
  return 0.5 * time * time * context.highest_force / context.axis.mass;
}

std::vector<double> grid(const SearchContext& context) {
  if (!context.response || context.axis.elastic()) return {};
  if (!sim::effects_of<sim::StructuralResonance>(context.axis).empty()) return {};
  std::vector<double> shares;
  for (double share = 0.2; share < 0.88; share += 0.05) shares.push_back(share);
  return shares;
}
template <int half_milliseconds>
Columns columns(const SearchContext& context, const Motion& motion, double share) {
  const auto& axis = context.axis;
  const double in_front = (1.0 - share) * axis.mass, width = width_of<half_milliseconds>(context);
  auto carried = force_along(axis, motion);
  for (std::size_t i = 0; i < carried.size(); ++i) carried[i] -= in_front * motion.a[i];
  const auto lead = lead_of(carried, motion.period, share * in_front, width);
  std::vector<double> column(lead.size());
  for (std::size_t i = 1; i + 1 < lead.size(); ++i)
    column[i] = in_front * (lead[i + 1] - 2.0 * lead[i] + lead[i - 1]) / (motion.period * motion.period * width);
  return {column};
}
template <int half_milliseconds>
bool possible(const SearchContext& context, double share, const Eigen::VectorXd& w) {
  if (share < least_behind || share > most_behind) return false;
  constexpr double reach = 8.0;
  const double width = width_of<half_milliseconds>(context);
  return w[0] > width / reach && w[0] < reach * width;
}
void describe(const SearchContext& context, double share, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "width", {w[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "mass_ratio", {share}, {std::sqrt(c(1, 1))});
}
// The instants are sharp, and the columns know neither the drive's answer nor what a contact gives.
std::vector<machine::KeyedValues> starts(const machine::KeyedValues& values) {
  std::vector<machine::KeyedValues> near;
  for (const double times : {0.35, 0.5, 0.7, 1.0, 1.4})
    for (const double more : {-0.15, -0.1, -0.05, 0.0, 0.05, 0.1}) {
      auto other = values;
      other.at("width")[0] *= times;
      other.at("mass_ratio")[0] = std::clamp(other.at("mass_ratio")[0] + more, least_behind, most_behind);
      near.push_back(std::move(other));
    }
  return near;
}
template <int half_milliseconds>
constexpr Candidate gap{.grid = grid,
                        .columns = columns<half_milliseconds>,
                        .possible = possible<half_milliseconds>,
                        .describe = describe,
                        .starts = starts,
                        .shape = true,
                        .two_bodies = true};
const std::array<Candidate, 4> forces{gap<1>, gap<2>, gap<4>, gap<8>};

}  // namespace heavy
}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = possible,
                                                 .describe = describe,
                                                 .at_weight = true,
                                                 .replays = true,
                                                 .coarse = coarse},
                                       .other_forces = heavy::forces};

}  // namespace stiction::host::effects::backlash
