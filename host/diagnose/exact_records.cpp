#include "host/diagnose/exact_records.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "host/diagnose/record/cycle_mean.hpp"
#include "host/diagnose/record/encoder_noise.hpp"
#include "host/diagnose/record/followed_set_points.hpp"
#include "host/diagnose/record/held_still.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/redrawn_residual.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/identify/identification.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/on_all_cores.hpp"

namespace stiction::host {
namespace {

// Runs of the exact machine under drawn forces.
class DrawnRuns {
 public:
  // `on_axis`: N, of the rows of `original`, like which forces are drawn. Without `windings` its motor is as fast as it
  // is told to be.
  DrawnRuns(const Prepared& prepared, const DiagnoseInput& input, const Record& original,
            const Eigen::VectorXd& on_axis, bool windings)
      : axis_model_(prepared.axis),
        original_(original),
        machine_(input.machine),
        axis_(input.axis),
        disturbance_(redrawn(on_axis)),
        driven_(with_recorded_set_points(input.machine.axes[input.axis], original_.logs, prepared.settings.cutoff)) {
    if (!windings) without_windings(machine_.axes[axis_]);
    if (const auto noise = encoder_noise(original.logs, original.simulated, machine_.axes[axis_]))
      machine_.axes[axis_].encoder.noise = *noise;
  }

  const machine::Machine& machine() const { return machine_; }
  std::size_t axis() const { return axis_; }

  RedrawnResidual redrawn(const Eigen::VectorXd& noise) const {
    return {without_cycle_mean(noise, original_.rows, original_.logs, axis_model_), original_.regressors,
            original_.rows.time, original_.rows.period(0)};
  }
  // As the drive would have recorded them, with the set-points that the record has; none where it trips.
  std::vector<std::optional<std::vector<Log>>> operator()(std::size_t begin, std::size_t end) const {
    std::vector<std::vector<Log>> forced;
    for (std::size_t draw = begin; draw < end; ++draw) forced.push_back(under_forces(draw));
    auto machine = machine_of_axis(machine_, axis_);
    machine.axes.front().encoder.noise_draw = begin * original_.rows.logs().size();
    auto runs = replays_together(machine, forced);
    std::vector<std::optional<std::vector<Log>>> all(runs.size());
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (runs[k]) all[k] = recorded(std::move(*runs[k]));
    return all;
  }

 private:
  // The logs that are replayed under a draw of the forces.
  std::vector<Log> under_forces(std::size_t draw) const {
    auto logs = replay_setup_of(machine_, axis_, driven_).logs;
    for (std::size_t k = 0; k < logs.size(); ++k) {
      auto& force = logs[k].axes.front().external_force;
      force.resize(logs[k].t.size(), 0.0);
      const auto drawn = disturbance_.drawn(k, logs[k].t, draw * logs.size() + k);
      std::transform(force.begin(), force.end(), drawn.begin(), force.begin(), std::plus<>());
    }
    return logs;
  }
  std::vector<Log> recorded(std::vector<Log> logs) const {
    for (std::size_t k = 0; k < logs.size(); ++k) {
      auto& channels = logs[k].axes.front();
      const auto& original = channels_of(original_.logs[k], axis_model_);
      logs[k].source = original_.logs[k].source;
      channels.external_force = original.external_force;
      if (original.x_set.empty())
        for (auto* set : {&channels.x_set, &channels.v_set, &channels.a_set}) set->clear();
    }
    return logs;
  }

  const machine::AxisModel& axis_model_;
  const Record& original_;
  machine::Machine machine_;  // of the file
  std::size_t axis_;
  RedrawnResidual disturbance_;
  std::vector<Log> driven_;  // with set-points
};

class Maker {
 public:
  // What the file leaves of its own run is told by the motor that the draws have: one without windings.
  Maker(const Prepared& prepared, const DiagnoseInput& input, const Record& original, const ForceOnAxis::Parts& noise)
      : prepared_(prepared),
        original_(original),
        beside_(original.logs, original.rows, prepared.axis, prepared.settings),
        runs_(prepared, input, original, noise.on_axis, false),
        own_motion_(!prepared.known_motion || !have_set_points(original_.logs, prepared.axis)) {
    if (noise.in_record.size() > 0) in_record_ = runs_.redrawn(noise.in_record);
    if (own_motion_) return;
    own_ = mean_own_residual(runs_of_target(original_, runs_.machine(), runs_.axis()), original_.logs, prepared.axis,
                             prepared.settings);
    silent_ = rows_of(original_.simulated, prepared.axis, prepared.settings).velocity;
  }

  std::vector<ExactRecord> operator()(std::size_t begin, std::size_t end) const {
    auto runs = runs_(begin, end);
    std::vector<std::optional<ExactRecord>> made(runs.size());
    on_all_cores(runs.size(), [&](std::size_t k) {
      if (runs[k]) made[k] = measured(std::move(*runs[k]));
      if (made[k]) made[k]->target += added_to_record(begin + k);
    });
    std::vector<ExactRecord> followed;
    for (auto& record : made)
      if (record) followed.push_back(std::move(*record));
    return followed;
  }

 private:
  const LogRows& rows() const { return original_.rows; }

  // N, of the rows: what a record has in a draw beside its forces.
  Eigen::VectorXd added_to_record(std::size_t draw) const {
    Eigen::VectorXd added = Eigen::VectorXd::Zero(rows().rows());
    const auto& logs = rows().logs();
    for (std::size_t k = 0; in_record_ && k < logs.size(); ++k) {
      const auto begin = static_cast<Eigen::Index>(logs[k]);
      const std::size_t length = rows().end(k) - logs[k];
      const auto drawn = in_record_->drawn(k, {rows().time.data() + begin, length}, ~(draw * logs.size() + k));
      added.segment(begin, static_cast<Eigen::Index>(length)) =
          Eigen::Map<const Eigen::VectorXd>(drawn.data(), static_cast<Eigen::Index>(length));
    }
    return added.cwiseProduct(original_.regressors.counts());
  }

  // What these `runs` are as a record; none where the machine cannot follow them once more.
  std::optional<ExactRecord> measured(std::vector<Log> runs) const {
    try {
      Record record;
      record.logs = std::move(runs);
      measure(record, prepared_.axis, prepared_.settings);
      if (!prepare(record)) return std::nullopt;
      if (original_.friction == FrictionAlong::simulated_motion)
        record.target +=
            (own_motion_ ? RecordsBesideRuns(record.logs, record.rows, prepared_.axis, prepared_.settings) : beside_)
                .friction_off(record.rows, record.regressors);
      for (const auto* own : {&original_.of_exact_records, &original_.of_disturbance})
        if (own->size() > 0) record.target -= own->cwiseProduct(record.regressors.counts());
      ExactRecord made{std::move(record.target), std::nullopt};
      if (own_motion_) {
        made.regressors = std::move(record.regressors);
      } else {
        for (const auto& motion : record.rows.motions()) made.read.push_back(motion.read);
        made.speed = (record.rows.velocity - silent_).cwiseProduct(original_.regressors.counts());
      }
      return made;
    } catch (const FaultTripped&) {
      return std::nullopt;
    }
  }

  // Gives regressors to the `record`, and takes what the file leaves of its own run off the target; false where the
  // machine cannot follow it.
  bool prepare(Record& record) const {
    if (own_motion_) {
      const auto motion = prepared_.known_motion ? drive(record, runs_.machine(), runs_.axis(),
                                                         Following::as_near_as_it_comes, original_.driven)
                                                 : std::vector<Log>{};
      if (prepared_.known_motion && motion.empty()) return false;
      regress_on(record, motion, prepared_.axis, prepared_.settings);
    } else {
      record.regressors = original_.regressors;
      // As the file's own run was taken: where it holds still and the record moves, nothing is left of it.
      record.target = (beside_.left_of(record.rows) - own_).cwiseProduct(record.regressors.counts());
    }
    return true;
  }

  const Prepared& prepared_;
  const Record& original_;
  RecordsBesideRuns beside_;  // the original's
  DrawnRuns runs_;
  std::optional<RedrawnResidual> in_record_;
  bool own_motion_;  // whether each draw has regressors of its own
  // Of the file's own run, in the rows, where that is the same in every draw.
  Eigen::VectorXd own_;     // N, what the file leaves of it
  Eigen::VectorXd silent_;  // m/s
};

constexpr std::size_t first_answer = 2000, answers = 2;  // draws of none that prices a name
constexpr int rounds_of_answers = 2;  // an axis in a limit cycle answers to half a force by more than half

}  // namespace

ExactRecords exact_records(const Prepared& prepared, const DiagnoseInput& input, const Record& original,
                           const ForceOnAxis::Parts& noise) {
  return [maker = std::make_shared<Maker>(prepared, input, original, noise)](std::size_t begin, std::size_t end) {
    return (*maker)(begin, end);
  };
}

ExactLogs exact_logs(const Prepared& prepared, const DiagnoseInput& input, const Eigen::VectorXd& on_axis) {
  return [runs = std::make_shared<DrawnRuns>(prepared, input, prepared.training, on_axis, true)](std::size_t begin,
                                                                                                 std::size_t end) {
    std::vector<std::vector<Log>> all;
    for (auto& each : (*runs)(begin, end))
      if (each) all.push_back(std::move(*each));
    return all;
  };
}

ForceOnAxis force_on_axis(const Prepared& prepared, const DiagnoseInput& input) {
  const auto& record = prepared.training;
  if (prepared.context.disturbed_motion || !prepared.context.exact_records) return {};
  const auto silent = rows_of(record.simulated, prepared.axis, prepared.settings).velocity;
  ForceOnAxis force(record.target, (record.rows.velocity - silent).cwiseProduct(record.regressors.counts()),
                    record.rows.logs());
  const auto answered = [&] {
    std::vector<ForceOnAxis::Answer> all;
    const auto records = exact_records(prepared, input, record, {force.parts_of(record.target).on_axis});
    for (auto& each : records(first_answer, first_answer + answers))
      all.push_back({std::move(each.speed), std::move(each.target)});
    return all;
  };
  for (int round = 0; round < rounds_of_answers; ++round) force.take_answers(answered());
  force.take_remainders(answered());
  return force;
}

}  // namespace stiction::host
