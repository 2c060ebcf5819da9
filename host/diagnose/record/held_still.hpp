// Records that move where the file's run of them holds still: friction without a contact is a reaction there, which the
// run leaves open, while the record tells what it is. So the record stays in the residual force, the run has no share
// in it, and columns go along the measured motion.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Whether runs of the `axis` do: friction is a reaction, and no motor twists a shaft in front of a load that sticks.
bool runs_hold_still(const machine::AxisModel& axis);

// Where a record moves so fast that its encoder tells the direction.
struct RecordMoves {
  double speed = 0.0;           // m/s, from which it does
  double least_distance = 0.0;  // m, that it goes where a run of the file holds still
  std::vector<double> samples;  // 1 for each that does, else 0; empty where runs do not hold still
  std::vector<double> x;        // m
};

// `log` of the record, `motion` made of it; `axis` of the file; `cutoff` of the position's filter (Hz).
RecordMoves moves_of_record(const Log& log, const Motion& motion, const machine::AxisModel& axis, double cutoff);

// 1 for each sample in which the `record` moves and the `run` of it holds still, else 0. `cutoff`: as above.
std::vector<double> of_record_alone(const RecordMoves& record, const Motion& run, double cutoff);

// N, what the file of the `axis` leaves of a `run` at each sample: nothing where the `record` alone moves. `cutoff`: as
// above.
std::vector<double> left_of_run(const Motion& run, const machine::AxisModel& axis, const RecordMoves& record,
                                double cutoff);

// Records beside runs of theirs.
class RecordsBesideRuns {
 public:
  // `logs` of the records, as rows `measured`, which have to outlive this; `axis` of the file; `settings` of the rows.
  RecordsBesideRuns(const std::vector<Log>& logs, const LogRows& measured, const machine::AxisModel& axis,
                    const SignalSettings& settings);

  // N, left_of_run() of each, in the rows of the `runs`.
  Eigen::VectorXd left_of(const LogRows& runs) const;
  // N, what friction along each run's own motion has beyond that along another, in the rows `along` that; nothing where
  // the record alone moves.
  Eigen::VectorXd friction_off(const LogRows& runs, const LogRows& along) const;
  // The motion of the `runs`, and where the record alone moves the record's.
  LogRows joined_motion(const LogRows& runs) const;
  // 1 for each row in which the record moves and so do the `runs`, or the record alone; else 0.
  Eigen::VectorXd moving(const LogRows& runs) const;

 private:
  std::vector<double> alone(const LogRows& runs, const Motion& run) const;

  const LogRows& measured_;
  machine::AxisModel axis_;
  SignalSettings settings_;
  std::vector<RecordMoves> moves_;  // of each log
};

}  // namespace stiction::host
