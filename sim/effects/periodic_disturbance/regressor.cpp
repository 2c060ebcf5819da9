// A force on the carriage at a fixed frequency, whatever the motion; in each record with a phase of its own. The
// periods to try are lines of the residual's spectrum over time (line_scan.hpp).
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::periodic_disturbance {
namespace {

const LineScan& scan(const SearchContext& context) { return context.times; }
std::vector<double> grid(const SearchContext& context) { return scan(context).periods; }
Columns columns(const SearchContext&, const Motion& motion, double period) {
  Columns pair(2, std::vector<double>(motion.t.size()));
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * motion.t[i] / period;
    pair[0][i] = -std::cos(phase);
    pair[1][i] = -std::sin(phase);
  }
  return pair;
}
// The phase is that of the first record.
void describe(const SearchContext& context, double period, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  const auto wave = first_wave(w);
  const auto last = c.rows() - 1;
  add_key(context, finding, "frequency", {1.0 / period}, {std::sqrt(c(last, last)) / (period * period)});
  add_key(context, finding, "cosine", {wave[0]}, {std::sqrt(c(0, 0))});
  add_key(context, finding, "sine", {wave[1]}, {std::sqrt(c(1, 1))});
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = any,
                                                 .describe = describe,
                                                 .shape = true,
                                                 .periodic = true,
                                                 .per_record = true,
                                                 .scan = scan}};

}  // namespace stiction::host::effects::periodic_disturbance
