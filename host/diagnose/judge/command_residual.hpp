// The second residual: what the drive commanded, less what the file's controller gives for the recorded set-points and
// positions (command_replay.hpp). A wrong gain or integral time and a delay in the loop show here and leave nothing in
// the residual force. Regressors are differences of such replays with one parameter changed; they are chosen by the
// odds of whitened rows (command_search.hpp). A change such as records of the exact machine seem to have is no cause.
#pragma once

#include "host/diagnose/judge/command_rows.hpp"
#include "host/diagnose/record/diagnose_input.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// By how much the current came late in the records (s) as the residual force says, with its standard error.
struct RecordDelay {
  double found = 0.0;     // named by the residual force's search; taken out
  double estimate = 0.0;  // of what its residual still has
  double deviation = 0.0;
};

// Adds findings and the figures of the command residual to the verdict, where all records have what it takes.
// `verdict`: to which they are added; `input`: of the diagnosis; `training` and `held_out` records; `delay`: that of
// the residual force; `exact`: the training records of the exact machine.
void judge_command(Verdict& verdict, const DiagnoseInput& input, const CommandRecords& training,
                   const CommandRecords& held_out, const RecordDelay& delay, const ExactLogs& exact);

}  // namespace stiction::host
