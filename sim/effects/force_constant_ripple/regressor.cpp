// A force periodic in position and proportional to the current: where the carriage gets F (1 + r(x)) of the motor's F,
// the motor needs (m a + friction) (1 - r(x)) in first order. The force that the file expects stands for F, or the
// noise of the current would correlate with itself. The pitches to try come from line_scan.hpp.
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::force_constant_ripple {
namespace {

const LineScan& scan(const SearchContext& context) { return context.modulation; }
std::vector<double> grid(const SearchContext& context) { return scan(context).periods; }
Columns columns(const SearchContext& context, const Motion& motion, double pitch) {
  const auto force = force_along(context.axis, motion);
  Columns pair(2, std::vector<double>(force.size()));
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * motion.x[i] / pitch;
    pair[0][i] = -force[i] * std::cos(phase);
    pair[1][i] = -force[i] * std::sin(phase);
  }
  return pair;
}
bool possible(const SearchContext&, double, const Eigen::VectorXd& w) { return std::hypot(w[0], w[1]) < 0.5; }
void describe(const SearchContext& context, double pitch, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_wave_keys(context, finding, "pitch", pitch, w, c);
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = possible,
                                                 .describe = describe,
                                                 .shape = true,
                                                 .periodic = true,
                                                 .scan = scan}};

}  // namespace stiction::host::effects::force_constant_ripple
