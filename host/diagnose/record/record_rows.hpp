// Records as the rows that a diagnosis works on, in its band.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/log_rows.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The forces that a diagnosis looks at: those below 100 Hz, in which the share of an effect is counted; and of records
// in which these leave something without a name the faster ones too.
enum class RowBand { usual, wide };

// Rows that hold the forces of the `band`: of the usual one no further than to a tenth of the rate of the slowest of
// `logs`, of the wide one to a fifth.
SignalSettings signals_in(RowBand band, std::span<const Log> logs);

// Hz, up to which such rows hold forces.
double end_of_band(const SignalSettings& settings);

// Samples `begin` to before `end` of `log`.
Log part_of(const Log& log, std::size_t begin, std::size_t end);

// Time runs from the record's start, of parts of it too: what warms up does so from there. `log`: whose clock is set.
void count_from_start(Log& log);

// The rows of `axis` in `logs`, filtered by `settings`. Throws LogError for records that cannot be used.
LogRows rows_of(const std::vector<Log>& logs, const machine::AxisModel& axis, const SignalSettings& settings);

// N, what the file says of `axis` along the motion of `rows`.
Eigen::VectorXd expected_force(const LogRows& rows, const machine::AxisModel& axis);

// What a file makes of its own noise-free record: 0 but for what the inverse dynamics cannot know, and where the run
// holds still and the record moves (held_still.hpp). N, of the rows.
// `replayed`: the simulation's records; `logs`: those that it repeats; `axis`: of the file; `settings` of the rows.
Eigen::VectorXd own_residual(const std::vector<Log>& replayed, const std::vector<Log>& logs,
                             const machine::AxisModel& axis, const SignalSettings& settings);
// The mean of that over several `runs`, each of all `logs`; `axis` and `settings` as above.
Eigen::VectorXd mean_own_residual(const std::vector<std::vector<Log>>& runs, const std::vector<Log>& logs,
                                  const machine::AxisModel& axis, const SignalSettings& settings);

}  // namespace stiction::host
