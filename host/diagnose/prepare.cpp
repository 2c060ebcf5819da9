#include "host/diagnose/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/model/motor_force.hpp"
#include "host/diagnose/exact_floor.hpp"
#include "host/diagnose/exact_records.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/noise_floor.hpp"
#include "host/diagnose/record/record_checks.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/statistics/noise_model.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/own_identification.hpp"
#include "host/identify/standstill.hpp"
#include "host/identify/suitability.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr double shortest = 3.0;  // s, of the training logs together

template <class T>
std::vector<T> joined(std::vector<T> first, const std::vector<T>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// By the clocks of the records; where one begins anew, without pauses between them, the held-out ones behind the
// others. None of a single record, or of such that are not known by a source of their own.
Session session_of(const std::vector<Log>& training, const std::vector<Log>& held_out) {
  if (training.size() < 2 || held_out.empty()) return {};
  const auto logs = joined(training, held_out);
  const bool goes_on =
      std::is_sorted(logs.begin(), logs.end(), [](const Log& a, const Log& b) { return a.t.front() < b.t.back(); });
  Session session;
  double now = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto& t = logs[k].t;
    if (goes_on) now = t.front() - logs.front().t.front();
    if (!session.begins.emplace(logs[k].source, now).second) return {};
    now += t.back() - t.front();
    if (k + 1 == training.size()) session.end = now;
  }
  return session;
}

SearchContext context_of(const machine::AxisModel& axis, const LogRows& rows, const SignalSettings& settings) {
  SearchContext context;
  context.axis = axis;
  context.signals = settings;
  context.reversals = excitation_of(rows).reversals;
  context.force_is_current = context.other_axis = true;
  context.lowest_position = context.highest_position = rows.motions().front().x.front();
  for (const auto& motion : rows.motions()) {
    context.force_is_current = context.force_is_current && motion.force_is_current;
    context.other_axis = context.other_axis && !motion.other_a.empty();
    for (const double force : force_along(axis, motion))
      context.highest_force = std::max(context.highest_force, std::abs(force));
    context.duration = std::max(context.duration, motion.t.back() - motion.t.front());
    context.log_period = std::max(context.log_period, motion.period);
    for (std::size_t i = 0; i < motion.x.size(); ++i) {
      context.highest_speed = std::max(context.highest_speed, std::abs(motion.v[i]));
      context.lowest_position = std::min(context.lowest_position, motion.x[i]);
      context.highest_position = std::max(context.highest_position, motion.x[i]);
    }
  }
  return context;
}

std::string why_motion_is_measured(const DiagnoseInput& input) {
  auto all = input.logs;
  all.insert(all.end(), input.held_out.begin(), input.held_out.end());
  const auto refused = why_not_simulated(input.machine, input.axis, all);
  return fmt::format(
      "{} The regressors were computed from the measured motion, which contains the response of the control loop to "
      "the disturbances, so that elastic modes and delays cannot be judged.{}",
      refused.empty() ? "The logs have no set-points, or the simulation could not follow them." : refused + ".",
      refused.empty() ? " Log x_set." : "");
}

// The records on which a verdict is said to rest, with what was noticed in them.
void list_records(Verdict& verdict, const std::vector<Log>& training, const std::vector<Log>& held_out) {
  for (const auto& log : training) verdict.logs.push_back(log.source);
  for (const auto& log : held_out) verdict.holdout.push_back(log.source);
  for (const auto* records : {&training, &held_out})
    for (const auto& log : *records)
      for (const auto& note : log.notes) verdict.notes.push_back(fmt::format("{}: {}", log.source, note));
}

// The last third of each training log, which loses it.
std::vector<Log> hold_out_a_part(std::vector<Log>& training) {
  std::vector<Log> held_out;
  for (auto& log : training) {
    const std::size_t cut = log.t.size() * 2 / 3;
    held_out.push_back(part_of(log, cut, log.t.size()));
    log = part_of(log, 0, cut);
  }
  return held_out;
}

// Training and held-out logs of linear axes, checked.
void take_logs(Prepared& prepared, const DiagnoseInput& input, Verdict& verdict) {
  auto &training = prepared.training.logs, &held_out = prepared.held_out.logs;
  for (const auto* records : {&input.logs, &input.held_out})
    for (auto& question : questions_before(*records, prepared.axis)) verdict.questions.push_back(std::move(question));
  training = linear_logs(input.logs, input.machine.axes);
  held_out = linear_logs(input.held_out, input.machine.axes);
  for (auto* records : {&training, &held_out})
    for (auto& log : *records) count_from_start(log);
  list_records(verdict, training, held_out);
  for (const auto* records : {&training, &held_out})
    for (const auto& log : *records) refuse_unreachable_set_points(log, prepared.axis);
  refuse_same_record(training, held_out, prepared.axis);
  if (!held_out.empty()) return;
  verdict.holdout_is_a_part = true;
  verdict.notes.push_back(
      "No held-out log was given: the first two thirds of each log were used for the search and the last third for "
      "validation. Effects that repeat with the motion in both can still be taken for a cause. Record a different "
      "trajectory, with different speeds, stroke and accelerations, and give it with --holdout.");
  held_out = hold_out_a_part(training);
}

void take_rows(Prepared& prepared, Verdict& verdict) {
  for (auto* record : {&prepared.training, &prepared.held_out}) measure(*record, prepared.axis, prepared.settings);
  const auto& rows = prepared.training.rows;
  if (const double duration = excitation_of(rows).duration; duration < shortest)
    throw LogError(fmt::format("{}: found {:.3g} s of training data; expected at least {:g} s",
                               sources_of(rows.motions()), duration, shortest));
  for (auto* record : {&prepared.training, &prepared.held_out}) refuse_other_units(record->rows, record->expected);
  if (const auto note = suspected_file(rows, prepared.training.expected); !note.empty()) verdict.notes.push_back(note);
}

// The first record that has none; empty where all have.
std::string without_set_points(const Prepared& prepared) {
  for (const auto* record : {&prepared.training, &prepared.held_out})
    for (const auto& log : record->logs)
      if (channels_of(log, prepared.axis).x_set.empty()) return log.source;
  return "";
}

// The motion of the columns: the file's simulation of the records, where it goes their way; else the measured one.
void take_motion(Prepared& prepared, const DiagnoseInput& input, Verdict& verdict) {
  const auto training = drive(prepared.training, input.machine, input.axis);
  const auto held_out = training.empty() ? std::vector<Log>{} : drive(prepared.held_out, input.machine, input.axis);
  prepared.known_motion = !held_out.empty();
  prepared.context.measured_motion = !prepared.known_motion;
  prepared.context.disturbed_motion = !prepared.known_motion || !without_set_points(prepared).empty();
  if (!prepared.known_motion)
    verdict.notes.push_back(why_motion_is_measured(input));
  else if (const auto source = without_set_points(prepared); !source.empty())
    verdict.notes.push_back(fmt::format(
        "{}: no set-points. The simulation is driven so that it moves as recorded, up to twice the bandwidth of the "
        "position loop; elastic modes, the gains of the drive and position errors cannot be judged. Log x_set.",
        source));
  regress_on(prepared.training, held_out.empty() ? held_out : training, prepared.axis, prepared.settings);
  regress_on(prepared.held_out, held_out, prepared.axis, prepared.settings);
}

// The file's friction along the simulated motion instead of the measured one, where the direction of the measured one
// tells it and the residual is likelier so.
void take_friction(Prepared& prepared) {
  if (!sticks_rigidly(prepared.axis)) return;
  const auto& training = prepared.training;
  if (noise_log_likelihood(along_regressors(training, prepared.axis), training.regressors) <=
      noise_log_likelihood(training.target, training.regressors))
    return;
  for (auto* record : {&prepared.training, &prepared.held_out}) {
    record->target = along_regressors(*record, prepared.axis);
    record->friction = FrictionAlong::simulated_motion;
  }
}

// Runs of the training logs and of those held out, as runs of all; as many as both have.
std::vector<std::vector<Log>> joined_runs(const std::vector<std::vector<Log>>& training,
                                          const std::vector<std::vector<Log>>& held_out) {
  std::vector<std::vector<Log>> runs;
  for (std::size_t k = 0; k < std::min(training.size(), held_out.size()); ++k)
    runs.push_back(joined(training[k], held_out[k]));
  return runs;
}

// Records of the exact machine, where its drive is known and has something to go by.
void take_exact_records(Prepared& prepared, const DiagnoseInput& input) {
  const auto& axis = input.machine.axes[input.axis];
  const bool follows = axis.cascaded() && axis.position_controller.gain > 0.0;
  if (!follows && !without_set_points(prepared).empty()) return;
  if (!why_not_simulated(input.machine, input.axis, prepared.training.logs).empty()) return;
  prepared.context.exact_records = [&prepared, &input](const Eigen::VectorXd& force) {
    return exact_records(prepared, input, prepared.training, prepared.on_axis.parts_of(force));
  };
}

// The simulations in which causes are tried, and what the residual force itself does to the file's own residual.
void take_responses(Prepared& prepared, const DiagnoseInput& input) {
  if (!prepared.known_motion) return;
  auto &training = prepared.training, &held_out = prepared.held_out;
  const auto friction = training.friction;
  const auto logs = joined(training.driven, held_out.driven);
  const auto disturbed_by = [&prepared, &input, logs, friction](const Eigen::VectorXd& force) {
    const auto& rows = prepared.training.rows;
    return EffectResponse(input.machine, input.axis, logs, prepared.settings, friction,
                          Disturbance(prepared.on_axis.parts_of(force).on_axis, rows.logs(), rows.period(0)));
  };
  for (const auto limit_cycle : {QuantizerLimitCycle::simulated, QuantizerLimitCycle::smoothed})
    prepared.responses.emplace_back(input.machine, input.axis, logs, prepared.settings, friction, limit_cycle);
  prepared.context.disturb = [&prepared, disturbed_by](const Eigen::VectorXd& force) {
    prepared.context.response = disturbed_by(force);
  };
  prepared.context.disturb(training.target);
  // By the motor and on the parts of the encoder's increment that cancel with what the target is less.
  auto machine = input.machine;
  without_windings(machine.axes[input.axis]);
  EffectResponse own(
      machine, input.axis, logs, prepared.settings, friction,
      Disturbance(prepared.on_axis.parts_of(training.target).on_axis, training.rows.logs(), training.rows.period(0)));
  own.take_silence(
      joined_runs(runs_of_target(training, machine, input.axis), runs_of_target(held_out, machine, input.axis)));
  const auto of_disturbance = [&own](const Record& record) -> Eigen::VectorXd {
    return record.regressors.stacked([&own](const Motion& motion) { return own.of_disturbance(motion); })
        .cwiseProduct(record.regressors.counts());
  };
  // Where the record is quieter than what is left of it would make it, the runs in silence are the nearer ones.
  const Eigen::VectorXd off = of_disturbance(training);
  if (noise_log_likelihood(training.target - off, training.regressors) <=
      noise_log_likelihood(training.target, training.regressors))
    return;
  training.of_disturbance = off;
  held_out.of_disturbance = of_disturbance(held_out);
  for (auto* record : {&training, &held_out}) record->target -= record->of_disturbance;
}

}  // namespace

std::unique_ptr<Prepared> prepare(const DiagnoseInput& input, RowBand band, Verdict& verdict) {
  auto prepared = std::make_unique<Prepared>();
  prepared->axis = sim::plant_axis(input.machine.axes.at(input.axis));
  auto& motor = prepared->axis.motor;
  motor.force_constant = machine::acting_force_constant(motor);  // true values are told against what acts
  verdict.axis = prepared->axis.name;
  verdict.units = ShownUnits(prepared->axis.coordinate);
  verdict.machine = input.machine.id + ".toml";
  take_logs(*prepared, input, verdict);
  prepared->settings = signals_in(band, joined(prepared->training.logs, prepared->held_out.logs));
  take_rows(*prepared, verdict);
  prepared->context = context_of(prepared->axis, prepared->training.rows, prepared->settings);
  prepared->context.session = session_of(input.logs, input.held_out);
  prepared->context.timing = input.machine.timing;
  take_motion(*prepared, input, verdict);
  prepared->context.highest_residual = prepared->training.target.cwiseAbs().maxCoeff();
  prepared->context.resolved_force = resolution_of_dynamics * rms(prepared->training.expected);
  if (prepared->known_motion) take_friction(*prepared);
  take_exact_records(*prepared, input);
  prepared->on_axis = force_on_axis(*prepared, input);
  if (prepared->context.disturbed_motion) take_exact_floor_off(*prepared, input);
  take_responses(*prepared, input);
  return prepared;
}

}  // namespace stiction::host
