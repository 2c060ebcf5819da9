// Cogging: force on the carriage periodic in position, cosine_h cos(2 pi h x / pitch) + sine_h sin(2 pi h x / pitch).
// The pitches to try come from the residual's spectrum over position (line_scan.hpp).
#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::force_ripple {
namespace {

const LineScan& scan(const SearchContext& context) { return context.pitches; }
std::vector<double> grid(const SearchContext& context) { return scan(context).periods; }
Columns columns(const SearchContext&, const Motion& motion, double pitch) {
  return waves_over_position(motion, pitch, std::vector<double>(motion.x.size(), 1.0));
}
void describe(const SearchContext& context, double pitch, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_wave_keys(context, finding, "pitch", pitch, w, c);
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = any,
                                                 .describe = describe,
                                                 .shape = true,
                                                 .periodic = true,
                                                 .scan = scan}};

}  // namespace stiction::host::effects::force_ripple
