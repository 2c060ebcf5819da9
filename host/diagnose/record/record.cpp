#include "host/diagnose/record/record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "host/diagnose/record/followed_set_points.hpp"
#include "host/diagnose/record/held_still.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/standstill.hpp"

namespace stiction::host {
namespace {

// Of an encoder's increment, from the record's set-points on: of the run whose motion makes the columns, and of those
// whose residual is taken off the record's. No two share their increments, nor has the record those of the columns.
constexpr double part_of_columns = 0.375;
constexpr std::array parts_of_residual{0.125, 0.625, 0.875};

// Of a record without set-points the simulated motion is not known above its followed_up_to(): it reverses elsewhere
// than the measured one, and the file's friction differs between the two. Where it does so by more than what is left of
// the record elsewhere, a column of friction would describe that difference. 1: known; 0: not.
Eigen::VectorXd known_friction(const Record& record, const machine::AxisModel& axis, double cutoff) {
  Eigen::VectorXd known = Eigen::VectorXd::Ones(record.target.size());
  if (have_set_points(record.logs, axis)) return known;
  constexpr double of_normal = 0.6745;  // its deviations' median over its standard deviation
  const auto friction = [&](const Motion& motion) { return friction_along(axis, motion); };
  const Eigen::VectorXd off = record.rows.stacked(friction) - record.regressors.stacked(friction);
  Eigen::VectorXd sizes = record.target.cwiseAbs();
  const auto middle = sizes.begin() + sizes.size() / 2;
  std::nth_element(sizes.begin(), middle, sizes.end());
  const auto beside = static_cast<Eigen::Index>(std::ceil(0.5 / cutoff / record.rows.period(0)));
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (std::abs(off[i]) > *middle / of_normal) {
      const auto first = std::max<Eigen::Index>(i - beside, 0), end = std::min(i + beside + 1, off.size());
      known.segment(first, end - first).setZero();
    }
  return known;
}

// The runs without noise of the logs with set-points these `parts` of an encoder's increment further on, taken back by
// them; empty where they go another way, by `how`. None on an axis without increments.
std::vector<std::vector<Log>> runs_elsewhere(const machine::Machine& machine, std::size_t axis,
                                             const std::vector<Log>& driven, std::span<const double> parts,
                                             Following how) {
  const auto& model = machine.axes[axis];
  if (!(model.encoder.increment > 0.0)) return {};
  std::vector<std::vector<Log>> further;
  for (const double part : parts) {
    auto logs = driven;
    for (auto& log : logs)
      for (double& x : channels_of(log, model).x_set) x += part * model.encoder.increment;
    further.push_back(std::move(logs));
  }
  auto runs = runs_without_noise(machine, axis, further, how);
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (auto& log : runs[k])
      for (double& x : log.axes.front().x) x -= parts[k] * model.encoder.increment;
  return runs;
}

// The logs of `motion` with the positions of a run.
std::vector<Log> moved_as(std::vector<Log> motion, const std::vector<Log>& run, const machine::AxisModel& axis) {
  for (std::size_t k = 0; k < motion.size(); ++k) channels_of(motion[k], axis).x = run[k].axes.front().x;
  return motion;
}

}  // namespace

void measure(Record& record, const machine::AxisModel& axis, const SignalSettings& settings) {
  record.rows = rows_of(record.logs, axis, settings);
  record.expected = expected_force(record.rows, axis);
  record.target = record.rows.force - record.expected;
}

std::vector<std::vector<Log>> runs_of_target(const Record& record, const machine::Machine& machine, std::size_t axis) {
  const bool elsewhere = !record.simulated_elsewhere.empty();
  auto runs = elsewhere ? runs_elsewhere(machine, axis, record.driven, parts_of_residual, Following::as_recorded)
                        : std::vector<std::vector<Log>>{without_noise(machine, axis, record.driven).replayed};
  std::erase_if(runs, [](const auto& run) { return run.empty(); });
  if (!runs.empty()) return runs;
  return elsewhere ? record.simulated_elsewhere : std::vector<std::vector<Log>>{record.simulated};
}

std::vector<Log> drive(Record& record, const machine::Machine& machine, std::size_t axis, Following how,
                       const std::vector<Log>& made_by) {
  record.driven = with_set_points(machine, axis, record.logs, how, made_by);
  auto without = without_noise(machine, axis, record.driven, how);
  record.simulated = std::move(without.replayed);
  record.simulated_elsewhere.clear();
  record.moved_elsewhere.clear();
  if (!record.simulated.empty()) {
    std::vector<double> parts(parts_of_residual.begin(), parts_of_residual.end());
    parts.push_back(part_of_columns);
    auto runs = runs_elsewhere(machine, axis, record.driven, parts, how);
    if (!runs.empty()) {
      record.moved_elsewhere = std::move(runs.back());
      runs.pop_back();
    }
    std::erase_if(runs, [](const auto& run) { return run.empty(); });
    record.simulated_elsewhere = std::move(runs);
  }
  if (record.simulated_elsewhere.empty()) record.moved_elsewhere.clear();
  if (record.moved_elsewhere.empty()) record.simulated_elsewhere.clear();
  return std::move(without.motion);
}

void regress_on(Record& record, const std::vector<Log>& motion, const machine::AxisModel& axis,
                const SignalSettings& settings) {
  record.regressors = record.rows;
  Eigen::VectorXd moves = moving_rows(record.rows, axis, settings.cutoff);
  if (motion.empty()) {
    record.simulated.clear();
    record.simulated_elsewhere.clear();
    record.moved_elsewhere.clear();
  } else {
    // A record that reads the simulation's own increments is less by itself: of independent ones each run leaves alike.
    constexpr double alike = 0.5;  // of the square
    const Eigen::VectorXd shared = record.target - own_residual(record.simulated, record.logs, axis, settings);
    Eigen::VectorXd apart = shared;
    if (!record.simulated_elsewhere.empty())
      apart = record.target - mean_own_residual(record.simulated_elsewhere, record.logs, axis, settings);
    if (shared.squaredNorm() < alike * apart.squaredNorm()) record.simulated_elsewhere.clear();
    record.target = record.simulated_elsewhere.empty() ? shared : apart;
    const auto runs = rows_of(record.moved_elsewhere.empty() ? motion : moved_as(motion, record.moved_elsewhere, axis),
                              axis, settings);
    const RecordsBesideRuns beside(record.logs, record.rows, axis, settings);
    moves = beside.moving(runs);
    record.regressors = beside.joined_motion(runs);
    record.regressors.read_as(record.rows);
  }
  for (const auto* rows : {&record.rows, &record.regressors})
    moves.array() *= rows_after_first_slide(*rows, axis).array();
  record.regressors.weigh(motion.empty() ? moves : moves.cwiseProduct(known_friction(record, axis, settings.cutoff)));
  record.target = record.target.cwiseProduct(record.regressors.counts());
}

Eigen::VectorXd along_regressors(const Record& record, const machine::AxisModel& axis) {
  const auto friction = [&](const Motion& motion) { return friction_along(axis, motion); };
  return record.target +
         (record.rows.stacked(friction) - record.regressors.stacked(friction)).cwiseProduct(record.regressors.counts());
}

}  // namespace stiction::host
