// Records made ready for a diagnosis: checked, cut into training and held-out data, with the residual force that the
// file leaves in them, the motion that columns are made of, and the simulation of the same axis to try causes in.
#pragma once

#include <memory>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/record/diagnose_input.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Logs of one use, training or held-out, as rows.
struct Record {
  std::vector<Log> logs;       // of linear axes, their time from each one's start
  std::vector<Log> driven;     // the same with set-points for the simulation where they have none
  LogRows rows;                // as measured
  LogRows regressors;          // of the motion that columns are made of: the simulated one where there is one
  Eigen::VectorXd expected;    // N, what the file says of the measured motion
  Eigen::VectorXd target;      // N, what the file does not make of the force; rows at rest do not count
  std::vector<Log> simulated;  // the file's own runs of these logs; empty where it cannot follow
};

struct Prepared {
  machine::AxisModel axis;
  SignalSettings settings;
  Record training, held_out;
  bool known_motion = false;  // whether regressors are of simulated motion
  SearchContext context;      // its `disturb` changes this context
  // Of all records, where they can be simulated: as they hunt, and smoothed.
  std::vector<EffectResponse> responses;

  Prepared() = default;
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
};

// Notes and questions go to the `verdict`. Throws LogError for logs of the `input` that cannot be used
// (record_checks.hpp, suitability.hpp).
std::unique_ptr<Prepared> prepare(const DiagnoseInput& input, Verdict& verdict);

}  // namespace stiction::host
