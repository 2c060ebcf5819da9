// What the drive commanded in some records, in the rows of their residual force, and what the file's controller gives
// for the recorded set-points and positions (command_replay.hpp). The integrator of such a replay does not know where
// it began, and adds up what the record's encoder reads wrong: a constant and a straight line of each log say nothing.
// Slow rows count: a controller of a different gain answers to the same positions with a command that runs away.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/log_rows.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// Records of one kind with their rows.
struct CommandRecords {
  std::span<const Log> logs;
  const LogRows& rows;
  std::span<const Log> simulated;  // the file's own runs of the logs; empty where there are none
};

// Of the draws number begin to end, less one, those that a machine can follow: logs as its drive would have recorded
// them.
using ExactLogs = std::function<std::vector<std::vector<Log>>(std::size_t begin, std::size_t end)>;

class CommandRows {
 public:
  // `records`: all with a recorded command; `timing` and `axis` of the drive; `record_delay`: s, by which the current
  // came late in the records.
  CommandRows(const CommandRecords& records, const machine::Timing& timing, const machine::AxisModel& axis,
              double record_delay);

  const LogRows& rows() const { return records_.rows; }
  const machine::AxisModel& axis() const { return axis_; }
  const machine::Timing& timing() const { return timing_; }
  const Eigen::VectorXd& logged() const { return logged_; }
  // What any parameter has beside it: each log's constant and straight line, and what is left of a record's delay,
  // which is known to microseconds only.
  const std::vector<Eigen::VectorXd>& nuisances() const { return nuisances_; }
  // What the drive with the parameters of `axis` commands, by the firmware's numbers where they hold the axis.
  Eigen::VectorXd as_driven(const machine::AxisModel& axis) const;
  // What the command of `axis` changes by with each of command_parameters() at `places`, per its unit, on the way of
  // the file's own runs where there are some. Along recorded positions noise of the encoder that a log knows between
  // two ticks alone would be in regressors and residual alike, and look like a gain: own runs are instruments
  // (Soderstrom and Stoica, System Identification, 1989, chapter 8). In doubles: the drive's rounding has no slope.
  std::vector<Eigen::VectorXd> slopes(const machine::AxisModel& axis, std::span<const std::size_t> places) const;
  // Of some rows' values what is faster than `slowest_shown`.
  Eigen::VectorXd shown(Eigen::VectorXd values) const;

 private:
  template <class S>
  Eigen::VectorXd replayed(const machine::AxisModel& axis, std::span<const Log> logs) const;
  Eigen::VectorXd rows_of(const std::vector<std::vector<double>>& columns) const;

  const CommandRecords& records_;
  const machine::Timing& timing_;
  const machine::AxisModel& axis_;
  Eigen::VectorXd logged_;
  std::vector<Eigen::VectorXd> nuisances_;
};

// Slower than this a replay's command runs away from the recorded one by the encoder's steps alone: figures of a
// command residual are of what is faster.
inline constexpr double slowest_shown = 1.0;  // Hz

}  // namespace stiction::host
