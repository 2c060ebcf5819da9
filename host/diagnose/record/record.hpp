// Logs of one use, training or held-out, on their way to the residual force: as measured, beside the file's own run of
// them, and along the motion that regressors are made of.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/record/followed_set_points.hpp"
#include "host/identify/log_rows.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The motion along which the file's friction is computed where the residual force is: that of the record or run itself,
// or, of a law without a contact, the one that the file's simulation of the record makes. An encoder's noise makes the
// direction of the first chatter near standstill; what acts on the machine makes the second reverse elsewhere.
enum class FrictionAlong { own_motion, simulated_motion };

struct Record {
  std::vector<Log> logs;       // of linear axes, their time from each one's start
  std::vector<Log> driven;     // the same with set-points for the simulation where they have none
  LogRows rows;                // as measured
  LogRows regressors;          // of the motion that columns are made of: the simulated one where there is one
  Eigen::VectorXd expected;    // N, what the file says of the measured motion
  Eigen::VectorXd target;      // N, what the file does not make of the force; rows at rest do not count
  std::vector<Log> simulated;  // the file's own runs of these logs; empty where it cannot follow
  // The same on other parts of the encoder's increment: those of which was taken what the file leaves of its own runs,
  // and the one with the motion of the regressors. Empty: simulated has that part. Two that share their increments have
  // something in common that looks like a mode of the machine, and a quiet record may share those of simulated, at
  // least for a while: columns never do.
  std::vector<std::vector<Log>> simulated_elsewhere;
  std::vector<Log> moved_elsewhere;
  FrictionAlong friction = FrictionAlong::own_motion;  // in the target
  // N, what the residual force itself does to what the file leaves of its own run; the target is less that. Empty:
  // nothing was taken off.
  Eigen::VectorXd of_disturbance;
  // N, what exact machines leave of records that were made ready as this one; the target is less that. Empty: as above.
  Eigen::VectorXd of_exact_records;
};

// Gives the `record` with its logs the rows as measured, and what the file says of them and leaves. `axis` of the file
// as the plant has it; `settings` of the rows. Throws LogError.
void measure(Record& record, const machine::AxisModel& axis, const SignalSettings& settings);
// Runs of the `record` without noise by this `machine`, like those whose residual its target is less; those themselves
// where it goes another way. `axis`: its index in the machine.
std::vector<std::vector<Log>> runs_of_target(const Record& record, const machine::Machine& machine, std::size_t axis);
// Drives the file's machine through the logs of the `record`; returns them with the motion that it makes. Empty where
// it cannot follow, or, by `how`, goes another way. `machine` of the file; `axis`: its index; `made_by`: as for
// with_set_points().
std::vector<Log> drive(Record& record, const machine::Machine& machine, std::size_t axis,
                       Following how = Following::as_recorded, const std::vector<Log>& made_by = {});
// Regressors are of this `motion` (drive()) from now on, where the record reads its increments, or of that on others;
// where it is empty, of the measured one. The target is less what the file leaves of its own runs; rows at standstill
// and before the first slide do not count, nor, without set-points, those in which the file's friction differs between
// the two motions. `record`, `axis` and `settings` as above.
void regress_on(Record& record, const std::vector<Log>& motion, const machine::AxisModel& axis,
                const SignalSettings& settings);
// The target of the `record`, which has regressors, with the file's friction along the motion of those. `axis` as
// above.
Eigen::VectorXd along_regressors(const Record& record, const machine::AxisModel& axis);

}  // namespace stiction::host
