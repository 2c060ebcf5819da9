// An elastic mode between motor and measured position: the force that bends it, ModeColumns. The load's share r of the
// mass is scanned: it shows in the friction at reversals alone, where a weight of its own would take up whatever else a
// reversal leaves. The weights are 1/w^2 and 2 zeta/w^3.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/noise_floor.hpp"

namespace stiction::host::effects::structural_resonance {
namespace {

constexpr double largest_ratio = 0.99;
// Of the estimated damping ratio: far outside of what a mode has, the fifth derivative follows something else.
constexpr double least_damping = -0.5, largest_damping = 1.5;

std::vector<double> grid(const SearchContext& context) {
  if (context.axis.elastic()) return {};  // the plant has one mode, that of the file's shaft
  return {0.2, 0.35, 0.55, 0.85};
}
Columns columns(const SearchContext& context, const Motion& motion, double ratio) {
  const auto mode =
      mode_columns(context.axis.mass, std::min(ratio, largest_ratio), motion, force_along(context.axis, motion));
  return {mode.bend, mode.damping};
}
// s^2, 1/w^2 of the mode that adds to the acceleration in the share w_m^2 / w^2, as much as the straight line between
// two samples of an acceleration takes off it, at every frequency w_m: (w_m period)^2 / 12. Above it, at 551 Hz in logs
// of 1 ms, a mode is not told from set-points that nobody knows between the samples.
double least_bend(const SearchContext& context) { return context.log_period * context.log_period / 12.0; }
// What a mode adds to the acceleration grows with the square of the frequency, (w_m / w)^2; what the low-pass of
// learned set-points takes off it with the eighth power, (w_m / w_e)^8. They meet where a mode adds (w_e / w)^(8/3);
// less than inverse dynamics can be off by, with and without the mode, is no mode: one of more than thirteen times the
// edge w_e.
double most_frequency(const SearchContext& context) {
  return context.known_up_to * std::pow(2.0 * resolution_of_dynamics, -3.0 / 8.0);
}
double frequency_of(const Eigen::VectorXd& w) { return 0.5 / (std::numbers::pi * std::sqrt(w[0])); }
double damping_of(const Eigen::VectorXd& w) { return 0.5 * w[1] / (w[0] * std::sqrt(w[0])); }
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return w[0] > least_bend(context) && frequency_of(w) < most_frequency(context) && damping_of(w) > least_damping &&
         damping_of(w) < largest_damping;
}
void describe(const SearchContext& context, double ratio, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const double frequency = frequency_of(w);
  const Eigen::Vector2d slope(-1.5 * damping_of(w) / w[0], 0.5 / (w[0] * std::sqrt(w[0])));
  add_key(context, finding, "frequency", {frequency}, {0.5 * frequency / w[0] * std::sqrt(c(0, 0))});
  add_key(context, finding, "damping_ratio", {std::clamp(damping_of(w), 0.0, 1.0)},
          {std::sqrt(slope.dot(c.topLeftCorner(2, 2) * slope))});
  add_key(context, finding, "mass_ratio", {std::min(ratio, largest_ratio)}, {std::sqrt(c(2, 2))});
}

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .shape = true}};

}  // namespace stiction::host::effects::structural_resonance
