// An elastic mode, of a motor that drives the part that is not measured, or of a body behind the measured one
// (elastic_mode.hpp). Where the motion is a simulation's the mode is seen through the drive, whose velocity loop closes
// near such modes, so each frequency to try has columns of its own. They differ by less than the steps of the grid, and
// in size as the square of the frequency: the weight tells it between two of them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/elastic_mode.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/noise_floor.hpp"
#include "sim/effects/backlash/backlash.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host::effects::structural_resonance {
namespace {

constexpr double least_frequency = 12.0, step = 1.25;  // Hz; from one to the next
constexpr int steps = 22;                              // to 1300 Hz
// Of what shows a mode's damping is the least: columns have one that joints of machines have.
constexpr double usual_damping = 0.08, usual_ratio = 0.5;
constexpr double least_ratio = 0.02;
// Of a weight that says nothing of the frequency between two steps of the grid, which are sqrt(1.25^2 - 1) apart.
constexpr double beyond_a_step = 1.6;

// s^2: by how much of an acceleration's second derivative a mode adds to it, at frequencies below its own. As much is
// taken off an acceleration by the straight line between two samples, period^2 / 12: 551 Hz in logs of 1 ms. Less is
// not told from set-points that nobody knows between the samples.
double least_bend(const SearchContext& context) { return context.log_period * context.log_period / 12.0; }
double bend_of(double frequency) { return std::pow(2.0 * std::numbers::pi * frequency, -2.0); }

std::vector<double> grid(const SearchContext& context) {
  // The plant has one mode: that of the file's shaft, or of a gap between two bodies.
  if (context.axis.elastic()) return {};
  for (const auto& gap : sim::effects_of<sim::Backlash>(context.axis))
    if (gap.mass_ratio > 0.0) return {};
  // A mode lives on the fastest motion, in which the loop answers what disturbs the axis; learned set-points lack it.
  if (context.disturbed_motion) return {};
  auto all = geometric(least_frequency, least_frequency * std::pow(step, steps - 1), steps);
  std::erase_if(all, [&](double frequency) { return bend_of(frequency) * step * step < least_bend(context); });
  return all;
}

Columns columns_of(const SearchContext& context, const Motion& motion, const ElasticMode& mode) {
  auto load = force_along(context.axis, motion);
  for (std::size_t i = 0; i < load.size(); ++i) load[i] -= context.axis.mass * motion.a[i];
  return context.response ? mode_columns_in_loop(mode, context.axis, motion, load)
                          : mode_columns(mode, context.axis, motion, load);
}

void add_keys(const SearchContext& context, Finding& finding, const ElasticMode& mode, double of_frequency,
              double of_ratio) {
  add_key(context, finding, "frequency", {mode.frequency}, {of_frequency});
  add_key(context, finding, "damping_ratio", {mode.damping_ratio}, {mode.damping_ratio});
  add_key(context, finding, "mass_ratio", {mode.mass_ratio}, {of_ratio});
  if (mode.motor_measured) add_key(context, finding, "motor_measured", {1.0}, {});
}

// Weights: (scanned over own frequency)^2, and the same over r.
namespace before {

Columns columns(const SearchContext& context, const Motion& motion, double frequency) {
  return columns_of(context, motion, {frequency, usual_damping, usual_ratio, false});
}
double frequency_of(double frequency, const Eigen::VectorXd& w) { return frequency / std::sqrt(w[0]); }
bool possible(const SearchContext& context, double frequency, const Eigen::VectorXd& w) {
  return w[0] > 1.0 / beyond_a_step && w[0] < beyond_a_step && w[0] * bend_of(frequency) > least_bend(context);
}
void describe(const SearchContext& context, double frequency, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const double own = frequency_of(frequency, w), ratio = w[1] > w[0] ? w[0] / w[1] : 1.0 - least_ratio;
  add_keys(context, finding, {own, usual_damping, std::max(ratio, least_ratio), false},
           0.5 * own / w[0] * std::sqrt(c(0, 0)), ratio / std::max(w[1], w[0]) * std::sqrt(c(1, 1)));
}

}  // namespace before

// The scanned frequency is that of the body behind, the measured part held. Far below the mode the weight is the other
// part's share, whatever the measured one's is. A drive that is slow against the mode leaves both parts free, and the
// mode is where the measured one's share has it: each share has columns of its own, and the weight moves it to one
// nearby.
namespace behind {

ElasticMode mode_of(double frequency, double ratio) {
  const double root = std::sqrt(ratio);
  return {frequency / root, usual_damping / root, ratio, true};
}
template <int percent>
struct Share {
  static constexpr double usual = 0.01 * percent;

  static double ratio_of(const Eigen::VectorXd& w) { return 1.0 - (1.0 - usual) * w[0]; }
  static Columns columns(const SearchContext& context, const Motion& motion, double frequency) {
    return columns_of(context, motion, mode_of(frequency, usual));
  }
  static bool possible(const SearchContext& context, double frequency, const Eigen::VectorXd& w) {
    const double ratio = ratio_of(w);
    return ratio > least_ratio && ratio < 1.0 - least_ratio && (1.0 - ratio) * bend_of(frequency) > least_bend(context);
  }
  static void describe(const SearchContext& context, double frequency, const Eigen::VectorXd& w,
                       const Eigen::MatrixXd& c, Finding& finding) {
    const double ratio = ratio_of(w);
    const auto mode = mode_of(frequency, ratio);
    add_keys(context, finding, mode, 0.5 * (step - 1.0) * mode.frequency, (1.0 - usual) * std::sqrt(c(0, 0)));
  }
  static constexpr Candidate force{.grid = grid,
                                   .columns = columns,
                                   .possible = possible,
                                   .describe = describe,
                                   .like_dynamics = true,
                                   .trials = 4.0 * 3,  // with the shares
                                   .two_bodies = true};
};
const Candidate shares[] = {Share<25>::force, Share<50>::force, Share<75>::force};

}  // namespace behind
}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = before::columns,
                                                 .possible = before::possible,
                                                 .describe = before::describe,
                                                 .like_dynamics = true,
                                                 .trials = 4.0,
                                                 .two_bodies = true},
                                       .other_forces = behind::shares};

}  // namespace stiction::host::effects::structural_resonance
