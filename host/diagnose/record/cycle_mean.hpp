// What comes back in every cycle of a slave's master. A disturbance that comes back so has the motion for its cause:
// forces drawn like it, with the lines of its spectrum at the cycle's harmonics, would again be functions of the place,
// and an exact machine under them would show every cause that is one.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/log_rows.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// `values`, one of each of the `rows` of these `logs` of an `axis`, less their mean over the cycles at each place of
// the master, and as large as noise was before its part in that mean was taken: in logs whose master turns steadily
// through two cycles and more. Those of 0 do not count. The other logs keep their values.
Eigen::VectorXd without_cycle_mean(Eigen::VectorXd values, const LogRows& rows, const std::vector<Log>& logs,
                                   const machine::AxisModel& axis);

}  // namespace stiction::host
