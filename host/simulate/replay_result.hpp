// A measured log beside its replay on one or several simulated machines: figures and charts.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// One replay of the log.
struct ReplayCase {
  std::string label;  // what its curves are called: a friction model, a machine
  machine::Machine machine;
  Log simulated;
  std::string friction{};  // the friction model whose colour its curves take; empty: one of its own
};

// How a simulated axis differs from the measured one. Without the log's first `settling` seconds, in which the
// simulation's start dies out.
struct ReplayDifference {
  double position = 0.0;                  // m or rad rms, simulated - measured position
  double following_error = 0.0;           // m or rad rms, x_set - x simulated
  double measured_following_error = 0.0;  // m or rad rms; without an encoder's offset
  double effort = 0.0;                    // A, V, N or N m rms, simulated - measured
  double measured_effort = 0.0;           // rms of the measured one
  const char* effort_unit = "";           // "A", "V", "N", "N m"; empty: the log has none that the simulation has
};
inline constexpr double settling = 0.1;  // s
// `measured`, `simulated`: logs with the same times; `axis`: index in both; `offset`: encoder_offset() of the
// measured one.
ReplayDifference compare_replay(const Log& measured, const Log& simulated, std::size_t axis, double offset);

// "current", "voltage", "force" or "torque"; empty where there is no effort to compare. `difference`: of an axis.
std::string effort_name(const ReplayDifference& difference);

// The encoder_offset() of an axis of the log on the machine of a case. `measured`: the log; `replayed`: the case;
// `axis`: index in the log; `name`: of the machine's axis, for a log without axis names.
double replay_offset(const Log& measured, const ReplayCase& replayed, std::size_t axis, const std::string& name);

// Why an axis' replay must not be compared with the log: a test signal that the simulation of the case cannot have, as
// a clause. Empty: it can be compared. `measured`: the log; `replayed`: the case; `axis`: index in the log; `name`: of
// the machine's axis, for a log without axis names.
std::string withheld_replay(const Log& measured, const ReplayCase& replayed, std::size_t axis, const std::string& name);

// The experiment "replay" of all cases, which share the log's time. `cases`: at least one. `measured`: the log;
// `signals`: "fixed" or "double"; `axis`: of the machine, for a log without axis names.
sim::ExperimentResult replay_result(const Log& measured, const std::vector<ReplayCase>& cases,
                                    const std::string& signals, const std::string& axis);

}  // namespace stiction::host
