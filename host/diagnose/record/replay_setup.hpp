// One axis of a machine alone, with the logs that have set-points for it: what replays run on.
#pragma once

#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/record/disturbance.hpp"
#include "host/diagnose/record/followed_set_points.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/identify/motion.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct ReplaySetup {
  machine::Machine machine;  // of one axis, or of both where they act on each other
  std::vector<Log> logs;     // with their channels only, the axis' first
};

// Logs without set-points are left out. `coupled`: with the other axis of two, where a log has its set-points.
// `machine` of the file; `logs` that are replayed.
ReplaySetup replay_setup_of(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                            bool coupled = false);

// The `axis` with the equivalent motor, which takes a third of the time and moves it the same but for how it hunts.
void without_windings(machine::AxisModel& axis);

// Why replays of this axis would not be what was recorded: its controller is not known, or a test signal of `logs`
// cannot act in them, nor in those of the other axis if they are `coupled` ("FILE: found ..."). Empty when they are.
// `machine` of the file; `axis`: its index.
std::string why_not_simulated(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                              bool coupled = false);

// What the bench's axis makes of each log's set-points. Throws FaultTripped, LogError.
std::vector<Log> replays(const ReplaySetup& setup);
// Its position alone (m), at the log's samples.
std::vector<std::vector<double>> simulated_positions(const ReplaySetup& setup);

// Logs as the machine's simulation without the encoder's noise goes through them.
struct WithoutNoise {
  std::vector<Log> motion;    // the logs, with the simulated position
  std::vector<Log> replayed;  // the replays themselves
};
// The motion is the same logs with the simulated position in place of the measured one: the motion without what noise
// and the effects looked for did to it. A regressor of the measured motion carries the disturbance that it is regressed
// on, through the control loop (Gilson, Garnier, Young, Van den Hof 2011); one of this motion does not. Empty when a
// log has no set-points, when the machine cannot follow them, when it goes another way than the measured one, or when a
// test signal cannot act in the simulation.
// `axis`: its index; `how`: whether another way is allowed.
WithoutNoise without_noise(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                           Following how = Following::as_recorded);

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

  // `logs`: with set-points, of that axis; `settings`: those of the motions; `replayed`: what without_noise() has
  // replayed of them with that hunting, in their order, so that it need not be done again. `machine` of the file;
  // `limit_cycle`: of the quantizer at standstill; `friction`: as in the residual force of the records.
  EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                 const SignalSettings& settings, FrictionAlong friction,
                 QuantizerLimitCycle limit_cycle = QuantizerLimitCycle::simulated,
                 const std::vector<Log>& replayed = {});
  // Under forces like `disturbance`: what runs under them have in common; two, and more where they agree on so little
  // that what is left to chance in their common part is a force like those. `machine` of the file; `axis`: its index;
  // `settings` of the rows; `friction`: as in the residual force of the records.
  EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                 const SignalSettings& settings, FrictionAlong friction, const Disturbance& disturbance,
                 const std::vector<Log>& replayed = {});

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
    std::vector<double> silent;                // N, the residual without effects and disturbances
    std::vector<double> friction;              // N, the file's, along that run
    std::vector<std::vector<double>> without;  // N, without effects, of each run, once it was asked for
  };
  std::size_t index_of(const Motion& motion) const;
  const std::vector<double>& silent(Record& record) const;
  void take_silent(Record& record, const Log& replayed) const;
  const std::vector<double>& without(std::size_t record, std::size_t run);
  // The log of a record under one of many draws of the disturbance.
  Log disturbed(std::size_t record, std::size_t run) const;
  // Of a run of the record; `external_force` is known, and no residual.
  std::vector<double> residual(const Record& record, Log simulated, const std::vector<double>& external_force) const;
  std::vector<double> common(std::size_t record, const machine::Machine& machine, std::size_t most_runs);

  machine::Machine machine_;
  SignalSettings settings_;
  FrictionAlong friction_;
  Disturbance disturbance_;
  std::vector<Record> records_;
  // The last answers: a search's grid begins a refinement, a refinement's end begins the one in closed loop.
  struct Known {
    std::size_t record, runs;
    std::vector<machine::Effect> effects;
    std::vector<double> force;
  };
  std::deque<Known> known_;
};

}  // namespace stiction::host
