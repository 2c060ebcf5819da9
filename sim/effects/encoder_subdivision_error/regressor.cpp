// The encoder reads x + e(x), e periodic in its signal period. The acceleration and viscous friction of e are in what
// was read but needed no force: in crawls the column is - mass d2e/dt2. At higher speed the drive answers the error
// with currents that the log's samples fold down (encoder_error_response.hpp). The signal periods to try come from
// line_scan.hpp.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/encoder_error_response.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"

namespace stiction::host::effects::encoder_subdivision_error {
namespace {

const LineScan& scan(const SearchContext& context) { return context.signals_of_encoder; }
std::vector<double> grid(const SearchContext& context) { return scan(context).periods; }

Columns columns(const SearchContext& context, const Motion& motion, double period) {
  const auto lowpass = butterworth(4, 2.0 * std::min(context.signals.cutoff, 0.2 / motion.period) * motion.period);
  const EncoderErrorResponse response(context.axis, context.timing, motion.period);
  const double viscous = viscous_of(context.axis);
  // What the drive answers where it is too fast for the log's rate.
  std::vector<std::complex<double>> answer(motion.v.size());
  for (std::size_t i = 0; i < answer.size(); ++i)
    if (const double frequency = std::abs(motion.v[i]) / period; frequency >= 0.5 / motion.period)
      answer[i] = response.drive(frequency);
  const auto column = [&](double quarter) {
    std::vector<double> phase(motion.x.size()), error(motion.x.size());
    for (std::size_t i = 0; i < error.size(); ++i) {
      phase[i] = 2.0 * std::numbers::pi * std::remainder(motion.x[i] / period, 1.0) - quarter;
      error[i] = std::cos(phase[i]);
    }
    error = filter_both_ways(lowpass, error, default_padding(lowpass));
    const auto speed = central_difference(error, motion.period, context.signals.difference_points);
    auto force = central_difference(speed, motion.period, context.signals.difference_points);
    for (std::size_t i = 0; i < force.size(); ++i) {
      force[i] = -context.axis.mass * force[i] - viscous * speed[i];
      if (answer[i] == 0.0) continue;
      force[i] += answer[i].real() * std::cos(phase[i]) -
                  (motion.v[i] < 0.0 ? -answer[i].imag() : answer[i].imag()) * std::sin(phase[i]);
    }
    return force;
  };
  return {column(0.0), column(0.5 * std::numbers::pi)};
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
                                                 .scan = scan}};

}  // namespace stiction::host::effects::encoder_subdivision_error
