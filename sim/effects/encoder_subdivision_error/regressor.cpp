// The encoder reads x + e(x), e periodic in its signal period. The acceleration and viscous friction of e are in what
// was read but needed no force: in crawls the column is - mass d2e/dt2. At higher speed the drive answers the error
// with currents that the log's samples fold down (encoder_error_response.hpp). The signal periods to try come from
// line_scan.hpp.
#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/encoder_error_response.hpp"

namespace stiction::host::effects::encoder_subdivision_error {
namespace {

const LineScan& scan(const SearchContext& context) { return context.signals_of_encoder; }
std::vector<double> grid(const SearchContext& context) { return scan(context).periods; }

Columns columns(const SearchContext& context, const Motion& motion, double period) {
  return SeenEncoderError(motion, context.axis, context.timing, context.signals.difference_points,
                          context.signals.cutoff)
      .columns(period);
}
void describe(const SearchContext& context, double period, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_wave_keys(context, finding, "period", period, w, c);
}

}  // namespace

extern const EffectRegressor regressor{.force = {.grid = grid,
                                                 .columns = columns,
                                                 .possible = any,
                                                 .describe = describe,
                                                 .shape = true,
                                                 .periodic = true,
                                                 .scan = scan,
                                                 .of_reading = true}};

}  // namespace stiction::host::effects::encoder_subdivision_error
