#include "host/diagnose/exact_records.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "host/diagnose/record/disturbance.hpp"
#include "host/identify/identification.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::host {
namespace {

// The logs as the machine of the file makes them under a draw of the forces, without their set-points.
std::vector<Log> recorded(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& driven,
                          const Disturbance& disturbance, std::size_t draw) {
  auto setup = replay_setup_of(machine, axis, driven);
  for (std::size_t k = 0; k < setup.logs.size(); ++k) {
    auto& force = setup.logs[k].axes.front().external_force;
    force.resize(setup.logs[k].t.size(), 0.0);
    const auto drawn = disturbance.drawn(setup.logs[k].t, draw * setup.logs.size() + k);
    std::transform(force.begin(), force.end(), drawn.begin(), force.begin(), std::plus<>());
  }
  auto logs = replays(setup);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    auto& channels = logs[k].axes.front();
    const auto& original = channels_of(driven[k], machine.axes[axis]);
    logs[k].source = driven[k].source;
    channels.external_force = original.external_force;
    for (auto* set : {&channels.x_set, &channels.v_set, &channels.a_set}) set->clear();
  }
  return logs;
}

}  // namespace

ExactRecords exact_records(const Record& training, EffectResponse disturbed) {
  return [&training, exact = std::make_shared<EffectResponse>(std::move(disturbed))](
             std::size_t draw) -> std::optional<ExactRecord> {
    const auto of_motion = [&](const Motion& motion) { return exact->drawn(motion, draw); };
    try {
      return ExactRecord{training.regressors.stacked(of_motion).cwiseProduct(training.regressors.counts()), {}};
    } catch (const FaultTripped&) {
      return std::nullopt;
    }
  };
}

ExactRecords exact_records_to_follow(const Prepared& prepared, const DiagnoseInput& input,
                                     const Eigen::VectorXd& force) {
  const auto& rows = prepared.training.rows;
  return [&prepared, &input, disturbance = Disturbance(force, rows.logs(), rows.period(0))](
             std::size_t draw) -> std::optional<ExactRecord> {
    try {
      Record record;
      record.logs = recorded(input.machine, input.axis, prepared.training.driven, disturbance, draw);
      measure(record, prepared.axis, prepared.settings);
      const auto motion = drive(record, input.machine, input.axis);
      if (motion.empty()) return std::nullopt;
      regress_on(record, motion, prepared.axis, prepared.settings);
      return ExactRecord{std::move(record.target), std::move(record.regressors)};
    } catch (const FaultTripped&) {
      return std::nullopt;
    }
  };
}

}  // namespace stiction::host
