#include "host/diagnose/record/effect_response.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "host/diagnose/record/held_still.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/identify/identification.hpp"
#include "host/simulate/replay_together.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr double fine = 0.01;              // of the position controller's increment
constexpr std::size_t answers_kept = 6;    // of each log: a grid has two of backlash
constexpr std::size_t usual_runs = 2;      // a third one is half as much work again and names no more of a small gap
constexpr std::size_t most_runs_ever = 8;  // of a swing that keeps its phase for seconds two runs may agree by chance
constexpr std::size_t runs_of_disturbance = 4;
constexpr double much_chance = 0.25;  // of the disturbance's square
// So fine that the axis does not hunt in it, but no finer than the drive's number format holds.
double fine_increment(double increment) {
  constexpr double finest = 1.0 / static_cast<double>(FixedSignals::IncrementInverse::highest_raw);  // m
  return std::max(fine * increment, std::min(increment, finest));
}

bool same(std::span<const machine::Effect> one, std::span<const machine::Effect> other) {
  return std::equal(
      one.begin(), one.end(), other.begin(), other.end(),
      [](const machine::Effect& a, const machine::Effect& b) { return a.name == b.name && a.values == b.values; });
}

}  // namespace

EffectResponse::EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                               const SignalSettings& settings, FrictionAlong friction, QuantizerLimitCycle limit_cycle)
    : settings_(settings), friction_(friction) {
  auto setup = replay_setup_of(machine, axis, logs);
  machine_ = std::move(setup.machine);
  auto& own = machine_.axes.front();
  own.encoder.noise = 0.0;
  const auto file = sim::plant_axis(own);
  for (auto& log : setup.logs) {
    const auto& channels = log.axes.front();
    RecordMoves moves;
    if (runs_hold_still(file) && !channels.x.empty())
      moves = moves_of_record(log, motion_of(log, channels, own, Amperes::amplitude, settings), file, settings.cutoff);
    records_.push_back({std::move(log), std::move(moves), {}, {}, {}});
  }
  if (limit_cycle == QuantizerLimitCycle::simulated) return;
  own.position_controller.increment = fine_increment(own.position_controller.increment);
  without_windings(own);
}

EffectResponse::EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                               const SignalSettings& settings, FrictionAlong friction, const Disturbance& disturbance)
    : EffectResponse(machine, axis, logs, settings, friction) {
  without_windings(machine_.axes.front());
  disturbance_ = disturbance;
}

Log EffectResponse::forced(const Run& run) const {
  auto log = records_[run.record].log;
  if (!run.draw) return log;
  auto& force = log.axes.front().external_force;
  force.resize(log.t.size(), 0.0);
  const auto drawn = disturbance_.drawn(log.t, run.record * most_runs_ever + *run.draw);
  std::transform(force.begin(), force.end(), drawn.begin(), force.begin(), std::plus<>());
  return log;
}

std::vector<double> EffectResponse::residual(const Record& record, Log simulated,
                                             const std::vector<double>& external_force) const {
  const auto file = sim::plant_axis(machine_.axes.front());
  simulated.axes.front().external_force = external_force;
  const auto motion =
      motion_of(simulated, simulated.axes.front(), machine_.axes.front(), Amperes::amplitude, settings_);
  auto force = left_of_run(motion, file, record.moves, settings_.cutoff);
  if (friction_ == FrictionAlong::own_motion || record.friction.empty()) return force;
  const auto own = friction_along(file, motion);
  // Where the record alone moves its target has its friction along its own motion.
  for (std::size_t i = 0; i < force.size(); ++i)
    if (record.friction[i]) force[i] += own[i] - *record.friction[i];
  return force;
}

std::size_t EffectResponse::index_of(const Motion& motion) const {
  const auto found = std::find_if(records_.begin(), records_.end(), [&](const Record& record) {
    return record.log.source == motion.source && record.log.axes.front().x_set == motion.x_set;
  });
  if (found == records_.end()) throw std::out_of_range("no log of " + motion.source);
  return static_cast<std::size_t>(found - records_.begin());
}

void EffectResponse::take_silent(Record& record, const Log& replayed) const {
  record.silent = residual(record, replayed, record.log.axes.front().external_force);
  if (friction_ == FrictionAlong::own_motion) return;
  const auto& axis = machine_.axes.front();
  const auto file = sim::plant_axis(axis);
  const auto motion = motion_of(replayed, replayed.axes.front(), axis, Amperes::amplitude, settings_);
  const auto friction = friction_along(file, motion);
  record.friction.assign(friction.begin(), friction.end());
  const auto alone = of_record_alone(record.moves, motion, settings_.cutoff);
  for (std::size_t i = 0; i < alone.size(); ++i)
    if (alone[i] != 0.0) record.friction[i].reset();
}

void EffectResponse::take_silence(std::span<const std::vector<Log>> runs) {
  for (std::size_t k = 0; k < records_.size(); ++k) {
    std::vector<double> sum(records_[k].log.t.size(), 0.0);
    for (const auto& run : runs) {
      take_silent(records_[k], run[k]);
      std::transform(sum.begin(), sum.end(), records_[k].silent.begin(), sum.begin(), std::plus<>());
    }
    for (double& force : sum) force /= static_cast<double>(runs.size());
    records_[k].silent = std::move(sum);
  }
}

std::vector<std::optional<Log>> EffectResponse::replayed(std::span<const Run> runs) const {
  std::vector<Log> logs;
  std::vector<ReplayOf> which;
  for (const auto& run : runs) logs.push_back(forced(run));
  for (std::size_t k = 0; k < runs.size(); ++k) which.push_back({runs[k].machine, &logs[k]});
  std::vector<std::optional<Log>> all;
  for (auto& replayed : replay_together(which)) {
    auto& run = all.emplace_back();
    if (auto* log = std::get_if<Log>(&replayed)) run = std::move(*log);
    const auto& recorded = records_[runs[all.size() - 1].record].log;
    if (run && recorded.axes.front().force.empty()) run->axes.front().force.clear();
  }
  return all;
}

void EffectResponse::add_without(std::vector<Run>& runs, std::size_t index, std::size_t draws) const {
  const auto& record = records_[index];
  const auto asked = [&](std::optional<std::size_t> draw) {
    return std::ranges::any_of(
        runs, [&](const Run& run) { return run.record == index && run.draw == draw && run.machine == &machine_; });
  };
  if (record.unfollowed) return;
  if (record.silent.empty() && !asked({})) runs.push_back({index, {}, &machine_});
  if (!disturbance_) return;
  for (std::size_t draw = record.without.size(); draw < draws; ++draw)
    if (!asked(draw)) runs.push_back({index, draw, &machine_});
}

void EffectResponse::take_without(const Run& run, std::optional<Log> replayed) {
  auto& record = records_[run.record];
  if (!replayed)
    record.unfollowed = true;
  else if (!run.draw)
    take_silent(record, *replayed);
  else if (!record.unfollowed)
    record.without.push_back(residual(record, std::move(*replayed), forced(run).axes.front().external_force));
}

std::size_t EffectResponse::missing_runs(const Answer& answer, std::size_t most_runs) const {
  if (!answer.followed || records_[answer.record].unfollowed) return 0;
  const std::size_t most = disturbance_ ? std::min(most_runs, most_runs_ever) : 1;
  if (answer.runs < usual_runs) return std::min(most, usual_runs) - answer.runs;
  return answer.runs < most && !(answer.common.chance() < much_chance * disturbance_.mean_square()) ? 1 : 0;
}

void EffectResponse::add_run(Answer& answer, const Run& run, std::optional<Log> replayed) const {
  const auto& record = records_[run.record];
  answer.followed = answer.followed && replayed && !record.unfollowed;
  if (!answer.followed) return;
  auto force = residual(record, std::move(*replayed), forced(run).axes.front().external_force);
  const auto& own = run.draw ? record.without[*run.draw] : record.silent;
  for (std::size_t i = 0; i < force.size(); ++i) force[i] -= own[i];
  answer.common.add(force);
  ++answer.runs;
}

// In rounds: all that is known to be wanted runs together.
void EffectResponse::foresee(std::span<const Motion> motions, std::span<const std::vector<machine::Effect>> sets,
                             std::size_t most_runs) {
  std::vector<machine::Machine> machines(sets.size(), machine_);
  std::vector<Answer> answers;
  for (std::size_t set = 0; set < sets.size(); ++set) {
    auto& acting = machines[set].axes.front().effects;
    acting.insert(acting.end(), sets[set].begin(), sets[set].end());
    for (const auto& motion : motions)
      if (const auto record = index_of(motion); known(record, sets[set], most_runs) == nullptr)
        answers.push_back({record, set});
  }
  while (true) {
    std::vector<Run> runs;
    for (const auto& answer : answers) add_without(runs, answer.record, answer.runs + missing_runs(answer, most_runs));
    // Once any are needed, those of the other records come with them: they will be asked for next.
    if (!runs.empty())
      for (std::size_t k = 0; k < records_.size(); ++k) add_without(runs, k, std::min(usual_runs, most_runs));
    const std::size_t without = runs.size();
    std::vector<std::size_t> of_answer(without);
    for (std::size_t k = 0; k < answers.size(); ++k)
      for (std::size_t r = 0, missing = missing_runs(answers[k], most_runs); r < missing; ++r) {
        const std::size_t draw = answers[k].runs + r;
        runs.push_back(
            {answers[k].record, disturbance_ ? std::optional(draw) : std::nullopt, &machines[answers[k].set]});
        of_answer.push_back(k);
      }
    if (runs.empty()) break;
    auto replays = replayed(runs);
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (k < without)
        take_without(runs[k], std::move(replays[k]));
      else
        add_run(answers[of_answer[k]], runs[k], std::move(replays[k]));
  }
  for (const auto& answer : answers) {
    const auto& record = records_[answer.record];
    known_.push_back({answer.record, most_runs, sets[answer.set],
                      answer.followed && !record.unfollowed ? answer.common.estimate()
                                                            : std::vector<double>(record.log.t.size(), 0.0)});
  }
  const std::size_t most = std::max(answers_kept * records_.size(), answers.size());
  if (known_.size() > most) known_.erase(known_.begin(), known_.end() - static_cast<std::ptrdiff_t>(most));
}

std::vector<double> EffectResponse::of_disturbance(const Motion& motion) {
  const auto& record = records_[index_of(motion)];
  if (disturbance_) {
    std::vector<Run> runs;
    for (std::size_t k = 0; k < records_.size(); ++k) add_without(runs, k, runs_of_disturbance);
    auto replays = replayed(runs);
    for (std::size_t k = 0; k < runs.size(); ++k) take_without(runs[k], std::move(replays[k]));
  }
  if (!disturbance_ || record.unfollowed) return std::vector<double>(motion.t.size(), 0.0);
  CoherentMean part;
  for (std::size_t r = 0; r < runs_of_disturbance; ++r) {
    auto force = record.without[r];
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= record.silent[i];
    part.add(force);
  }
  return part.estimate();
}

std::vector<double> EffectResponse::operator()(const Motion& motion, const machine::Effect& effect,
                                               std::size_t most_runs) {
  return together(motion, {&effect, 1}, most_runs);
}

std::vector<double> EffectResponse::together(const Motion& motion, std::span<const machine::Effect> effects,
                                             std::size_t most_runs) {
  const auto record = index_of(motion);
  const auto* answer = known(record, effects, most_runs);
  if (answer == nullptr) {
    const std::vector<machine::Effect> set(effects.begin(), effects.end());
    foresee({&motion, 1}, {&set, 1}, most_runs);
    answer = &known_.back();
  }
  return answer->force;
}

const EffectResponse::Known* EffectResponse::known(std::size_t record, std::span<const machine::Effect> effects,
                                                   std::size_t most_runs) const {
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& each) {
    return each.record == record && each.runs == most_runs && same(each.effects, effects);
  });
  return found == known_.end() ? nullptr : &*found;
}

}  // namespace stiction::host
