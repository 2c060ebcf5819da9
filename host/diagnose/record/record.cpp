#include "host/diagnose/record/record.hpp"

#include <utility>

#include "host/diagnose/record/followed_set_points.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/identify/standstill.hpp"

namespace stiction::host {

void measure(Record& record, const machine::AxisModel& axis, const SignalSettings& settings) {
  record.rows = rows_of(record.logs, axis, settings);
  record.expected = expected_force(record.rows, axis);
  record.target = record.rows.force - record.expected;
}

std::vector<Log> drive(Record& record, const machine::Machine& machine, std::size_t axis) {
  record.driven = with_set_points(machine, axis, record.logs);
  auto without = without_noise(machine, axis, record.driven);
  record.simulated = std::move(without.replayed);
  return std::move(without.motion);
}

void regress_on(Record& record, const std::vector<Log>& motion, const machine::AxisModel& axis,
                const SignalSettings& settings) {
  record.regressors = record.rows;
  if (motion.empty()) {
    record.simulated.clear();
  } else {
    record.regressors = rows_of(motion, axis, settings);
    record.regressors.read_as(record.rows);
    record.target -= own_residual(record.simulated, record.logs, axis, settings);
  }
  const Eigen::VectorXd moves = moving_rows(record.rows, axis, settings.cutoff);
  record.regressors.weigh(moves.cwiseProduct(moving_rows(record.regressors, axis, settings.cutoff)));
  record.target = record.target.cwiseProduct(record.regressors.counts());
}

Eigen::VectorXd along_regressors(const Record& record, const machine::AxisModel& axis) {
  const auto friction = [&](const Motion& motion) { return friction_along(axis, motion); };
  return record.target +
         (record.rows.stacked(friction) - record.regressors.stacked(friction)).cwiseProduct(record.regressors.counts());
}

}  // namespace stiction::host
