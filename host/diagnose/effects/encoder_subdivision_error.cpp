// The encoder reads x + e(x), e periodic in its signal period; in each record with a phase of its own, for no home is
// known to a part of a signal period. What was read moved less e, the forces of the file are other ones: their
// difference over e is the column, in crawls nearly - mass d2e/dt2. At higher speed the drive answers the error with
// currents that the log's samples fold down (reading_response.hpp). The signal periods to try come from line_scan.hpp.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"
#include "host/diagnose/reading_response.hpp"

namespace stiction::host::effects {
namespace {

constexpr double probe = 1e-8;  // m, small beside a contact's length

const LineScan& scan(const Scene& scene) { return scene.signals_of_encoder; }
std::vector<double> grid(const Scene& scene) { return scan(scene).periods; }

Columns columns(const Scene& scene, const Motion& motion, double period) {
  const auto base = force_along(scene.axis, motion);
  const auto lowpass = butterworth(4, 2.0 * std::min(scene.signals.cutoff, 0.2 / motion.period) * motion.period);
  const ReadingResponse response(scene.axis, scene.timing, motion.period);
  const auto column = [&](double quarter) {
    auto moved = motion;
    std::vector<double> error(motion.x.size());
    for (std::size_t i = 0; i < error.size(); ++i)
      error[i] = probe * std::cos(2.0 * std::numbers::pi * motion.x[i] / period - quarter);
    error = filter_both_ways(lowpass, error, default_padding(lowpass));
    for (std::size_t i = 0; i < error.size(); ++i) moved.x[i] -= error[i];
    moved.v = central_difference(moved.x, motion.period, scene.signals.difference_points);
    moved.a = central_difference(moved.v, motion.period, scene.signals.difference_points);
    auto force = force_along(scene.axis, moved);
    for (std::size_t i = 0; i < force.size(); ++i) {
      force[i] = (force[i] - base[i]) / probe;
      const double frequency = std::abs(motion.v[i]) / period;
      if (frequency < 0.5 / motion.period) continue;
      const auto answer = response.drive(frequency);
      const double phase = 2.0 * std::numbers::pi * std::remainder(motion.x[i] / period, 1.0) - quarter;
      force[i] +=
          answer.real() * std::cos(phase) - (motion.v[i] < 0.0 ? -answer.imag() : answer.imag()) * std::sin(phase);
    }
    return force;
  };
  return {column(0.0), column(0.5 * std::numbers::pi)};
}
// The phase is that of the first record.
void describe(const Scene&, double period, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  const auto wave = first_wave(w);
  const auto last = c.rows() - 1;
  add_key(finding, "period", "_m", {period}, {std::sqrt(c(last, last))});
  add_key(finding, "cosine", "_m", {wave[0]}, {std::sqrt(c(0, 0))});
  add_key(finding, "sine", "_m", {wave[1]}, {std::sqrt(c(1, 1))});
}

}  // namespace

const Candidate encoder_subdivision_error{.name = "encoder_subdivision_error",
                                          .grid = grid,
                                          .columns = columns,
                                          .possible = any,
                                          .describe = describe,
                                          .nonlinear = true,
                                          .periodic = true,
                                          .per_record = true,
                                          .scan = scan};

}  // namespace stiction::host::effects
