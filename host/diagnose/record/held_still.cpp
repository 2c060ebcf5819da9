#include "host/diagnose/record/held_still.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/standstill.hpp"

namespace stiction::host {
namespace {

constexpr double sure_of_direction = 3.0;  // standard deviations of the speed
constexpr double beside = 0.01;            // of a row's filter, that may be in samples of another kind

// m/s rms, what the encoder's noise is in the filtered speed: white noise, whose part above the filter's edge the
// filter took off the position, and which is no less than that of the file's increment.
double speed_noise(const Log& log, const Motion& motion, const machine::AxisModel& axis, double cutoff) {
  const auto& raw = channels_of(log, axis).x;
  double square = 0.0;
  for (std::size_t i = 0; i < motion.x.size(); ++i) square += std::pow(raw[i] - motion.x[i], 2);
  square /= static_cast<double>(std::max<std::size_t>(motion.x.size(), 1));
  const double nyquist = 0.5 / motion.period;
  const double of_step = axis.encoder.increment * axis.encoder.increment / 12.0;
  const double density = std::max(square / std::max(nyquist - cutoff, 0.5 * nyquist), of_step / nyquist);  // m^2/Hz
  return 2.0 * std::numbers::pi * std::sqrt(density * cutoff * cutoff * cutoff / 3.0);
}

}  // namespace

bool runs_hold_still(const machine::AxisModel& axis) { return sticks_rigidly(axis) && !axis.elastic(); }

RecordMoves moves_of_record(const Log& log, const Motion& motion, const machine::AxisModel& axis, double cutoff) {
  if (!runs_hold_still(axis)) return {};
  const double speed = sure_of_direction * speed_noise(log, motion, axis, cutoff);
  return {speed, unresolved_distance(axis, cutoff), samples_faster_than(speed, motion, cutoff), motion.x};
}

// Of two that come to rest one a little later than the other neither is alone: that one gets no further.
std::vector<double> of_record_alone(const RecordMoves& record, const Motion& run, double cutoff) {
  if (record.samples.empty()) return std::vector<double>(run.v.size(), 0.0);
  auto alone = samples_faster_than(record.speed, run, cutoff);
  for (std::size_t i = 0; i < alone.size(); ++i) alone[i] = record.samples[i] * (1.0 - alone[i]);
  for (std::size_t begin = 0, end = 0; begin < alone.size(); begin = end) {
    end = begin + 1;
    while (end < alone.size() && alone[end] == alone[begin]) ++end;
    if (std::abs(record.x[end - 1] - record.x[begin]) > record.least_distance) continue;
    std::fill(alone.begin() + static_cast<std::ptrdiff_t>(begin), alone.begin() + static_cast<std::ptrdiff_t>(end),
              0.0);
  }
  return alone;
}

std::vector<double> left_of_run(const Motion& run, const machine::AxisModel& axis, const RecordMoves& record,
                                double cutoff) {
  auto left = force_along(axis, run);
  std::transform(left.begin(), left.end(), run.force.begin(), left.begin(),
                 [](double expected, double force) { return force - expected; });
  const auto alone = of_record_alone(record, run, cutoff);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] *= 1.0 - alone[i];
  return left;
}

RecordsBesideRuns::RecordsBesideRuns(const std::vector<Log>& logs, const LogRows& measured,
                                     const machine::AxisModel& axis, const SignalSettings& settings)
    : measured_(measured), axis_(axis), settings_(settings) {
  for (std::size_t k = 0; k < logs.size(); ++k)
    moves_.push_back(moves_of_record(logs[k], measured.motions()[k], axis, settings.cutoff));
}

std::vector<double> RecordsBesideRuns::alone(const LogRows& runs, const Motion& run) const {
  return of_record_alone(moves_[static_cast<std::size_t>(&run - runs.motions().data())], run, settings_.cutoff);
}

Eigen::VectorXd RecordsBesideRuns::left_of(const LogRows& runs) const {
  if (!runs_hold_still(axis_)) return runs.force - expected_force(runs, axis_);
  return runs.stacked([&](const Motion& run) {
    return left_of_run(run, axis_, moves_[static_cast<std::size_t>(&run - runs.motions().data())], settings_.cutoff);
  });
}

Eigen::VectorXd RecordsBesideRuns::friction_off(const LogRows& runs, const LogRows& along) const {
  return along.stacked([&](const Motion& motion) {
    const auto& run = runs.motions()[static_cast<std::size_t>(&motion - along.motions().data())];
    auto off = friction_along(axis_, run);
    const auto friction = friction_along(axis_, motion), record_alone = alone(runs, run);
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = (1.0 - record_alone[i]) * (off[i] - friction[i]);
    return off;
  });
}

LogRows RecordsBesideRuns::joined_motion(const LogRows& runs) const {
  if (!runs_hold_still(axis_)) return runs;
  auto motions = runs.motions();
  for (std::size_t k = 0; k < motions.size(); ++k) {
    auto& joined = motions[k];
    const auto &run = runs.motions()[k], &record = measured_.motions()[k];
    const auto record_alone = alone(runs, run);
    joined.moved.assign(run.x.size(), 0.0);
    for (std::size_t i = 0; i < run.x.size(); ++i) {
      const bool of_record = record_alone[i] != 0.0;
      if (i > 0) joined.moved[i] = of_record ? record.x[i] - record.x[i - 1] : run.x[i] - run.x[i - 1];
      if (of_record) joined.x[i] = record.x[i], joined.v[i] = record.v[i], joined.a[i] = record.a[i];
    }
  }
  return {std::move(motions), settings_};
}

Eigen::VectorXd RecordsBesideRuns::moving(const LogRows& runs) const {
  Eigen::VectorXd moves =
      moving_rows(measured_, axis_, settings_.cutoff).cwiseProduct(moving_rows(runs, axis_, settings_.cutoff));
  if (!runs_hold_still(axis_)) return moves;
  const Eigen::VectorXd of_record = measured_.stacked([&](const Motion& motion) {
    return moves_[static_cast<std::size_t>(&motion - measured_.motions().data())].samples;
  });
  const Eigen::VectorXd of_record_only = runs.stacked([&](const Motion& run) { return alone(runs, run); });
  for (Eigen::Index i = 0; i < moves.size(); ++i)
    if (std::abs(of_record[i] - 1.0) < beside && of_record_only[i] > beside) moves[i] = 1.0;
  return moves;
}

}  // namespace stiction::host
