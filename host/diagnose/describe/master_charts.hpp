// The pictures of a slave's record: what it does at each place of its master, how much of it comes back in every cycle,
// and at which orders of the master's and the motor's turns the residual force lies.
#pragma once

#include <Eigen/Dense>

#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Nothing where the first of `logs` has no master. `rows` of these logs of an `axis`; `before`, `after`: residual force
// in the rows (N), with the file's machine and with all causes. `verdict`: to which they are added.
void add_master_charts(Verdict& verdict, const std::vector<Log>& logs, const machine::AxisModel& axis,
                       const LogRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after);

}  // namespace stiction::host
