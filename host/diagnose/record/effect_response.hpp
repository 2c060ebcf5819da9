// What an effect does to the residual force of replayed logs, through the control loop.
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/record/disturbance.hpp"
#include "host/diagnose/record/held_still.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/diagnose/statistics/coherent_mean.hpp"
#include "host/identify/motion.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// Within an increment of its position controller an axis hunts. Near reversals a replay does so as the record did, and
// friction's contact follows it; elsewhere noise made the record hunt at other instants, and the difference is an error
// of the regressor that takes up to two thirds off the weight of an elastic mode. A finer increment leaves the motion
// that all records have in common.
enum class QuantizerLimitCycle { simulated, smoothed };

// What an effect does to the residual force of a replayed log, through the control loop. Motions are known by the
// source and the first time of the logs.
class EffectResponse {
 public:
  static constexpr auto as_needed = std::numeric_limits<std::size_t>::max();

  // `logs`: with set-points, of that axis; `settings`: those of the motions. `machine` of the file; `limit_cycle`: of
  // the quantizer at standstill; `friction`: as in the residual force of the records.
  EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                 const SignalSettings& settings, FrictionAlong friction,
                 QuantizerLimitCycle limit_cycle = QuantizerLimitCycle::simulated);
  // Under forces like `disturbance`: what runs under them have in common; two, and more where they agree on so little
  // that what is left to chance in their common part is a force like those. `machine` of the file; `axis`: its index;
  // `settings` of the rows; `friction`: as in the residual force of the records.
  EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                 const SignalSettings& settings, FrictionAlong friction, const Disturbance& disturbance);

  // Simulates at once what later calls will ask for: each of `sets` of effects that act together, on each of the
  // `motions`. `most_runs`: as there. Throws sim::EffectError, std::out_of_range as they do.
  void foresee(std::span<const Motion> motions, std::span<const std::vector<machine::Effect>> sets,
               std::size_t most_runs = as_needed);

  // In silence from now on: the mean of these `runs`, each of all logs in their order.
  void take_silence(std::span<const std::vector<Log>> runs);

  // N at the motion's rate: with the effect less without; zeros where the machine cannot follow with it. Of no more
  // than `most_runs`. Throws sim::EffectError, std::out_of_range for a motion of another log.
  std::vector<double> operator()(const Motion& motion, const machine::Effect& effect,
                                 std::size_t most_runs = as_needed);
  // The same of several effects that act together. `motion` of the record; `most_runs`: how many replays at most.
  std::vector<double> together(const Motion& motion, std::span<const machine::Effect> effects,
                               std::size_t most_runs = as_needed);
  // N at the motion's rate: what the disturbance does to the residual of the machine as it is, on average: hunting that
  // it ends or begins, friction that it smoothes. Zeros without disturbance.
  // Throws std::out_of_range for a motion of another log.
  std::vector<double> of_disturbance(const Motion& motion);

 private:
  struct Record {
    Log log;
    RecordMoves moves;
    std::vector<double> silent;                   // N, the residual without effects and disturbances
    std::vector<std::optional<double>> friction;  // N, the file's, along that run; nothing where the record alone moves
    std::vector<std::vector<double>> without;     // N, without effects, of each run, once it was asked for
    bool unfollowed = false;                      // whether the machine cannot follow, without effects
  };
  // A replay of a record, in silence or under one of many draws of the disturbance.
  struct Run {
    std::size_t record;
    std::optional<std::size_t> draw;
    const machine::Machine* machine;
  };
  // What a record answers to a set of effects, while it is made.
  struct Answer {
    std::size_t record, set;
    CoherentMean common{};  // of the runs with the effects, each less the one without under the same forces
    std::size_t runs = 0;   // that are in it
    bool followed = true;   // whether the machine could
  };
  // The last answers: a search's grid begins a refinement, a refinement's end begins the one in closed loop.
  struct Known {
    std::size_t record, runs;
    std::vector<machine::Effect> effects;
    std::vector<double> force;
  };

  std::size_t index_of(const Motion& motion) const;
  const Known* known(std::size_t record, std::span<const machine::Effect> effects, std::size_t most_runs) const;
  // The log that is replayed.
  Log forced(const Run& run) const;
  std::vector<std::optional<Log>> replayed(std::span<const Run> runs) const;
  // Of a run of the record; `external_force` is known, and no residual.
  std::vector<double> residual(const Record& record, Log simulated, const std::vector<double>& external_force) const;
  void take_silent(Record& record, const Log& replayed) const;
  // Adds the runs without effects that a record lacks: in silence, and under the first `draws`.
  void add_without(std::vector<Run>& runs, std::size_t record, std::size_t draws) const;
  void take_without(const Run& run, std::optional<Log> replayed);
  // How many runs an answer lacks, as far as is known.
  std::size_t missing_runs(const Answer& answer, std::size_t most_runs) const;
  void add_run(Answer& answer, const Run& run, std::optional<Log> replayed) const;

  machine::Machine machine_;
  SignalSettings settings_;
  FrictionAlong friction_;
  Disturbance disturbance_;
  std::vector<Record> records_;
  std::deque<Known> known_;
};

}  // namespace stiction::host
