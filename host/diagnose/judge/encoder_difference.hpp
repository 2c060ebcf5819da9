// The third residual: by how much the load is further ahead of its motor, as two encoders show it, than the file's
// shaft lets it be,
//   x_load - x_motor + f / k +- play / 2,  f = F - m_motor a_motor - friction at the motor.
// The motor is the gauge of the force through the shaft, so that neither the load's inertia nor what rubs on it is
// asked for; where nearly all of its force moves the motor itself, the load's own acceleration is. What the file leaves
// in its own runs of the records is taken off.
#pragma once

#include <optional>
#include <vector>

#include "host/diagnose/classes/encoder_cause.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

class EncoderDifference {
 public:
  // None where the `axis` (of the file as the plant has it) has no shaft or no encoder on each side of it, or a log of
  // the `record` lacks one. `settings` of the rows. Throws LogError.
  static std::optional<EncoderDifference> of(const Record& record, const machine::AxisModel& axis,
                                             const SignalSettings& settings);

  const LogRows& rows() const { return rows_; }
  const Eigen::VectorXd& target() const { return target_; }  // m
  // What is not asked of the records: each one's zeros of the encoders and what creeps, one that shows late, the
  // motor's friction, the side of a play, damping.
  const std::vector<Eigen::VectorXd>& nuisances() const { return nuisances_; }
  std::vector<Eigen::VectorXd> columns(const EncoderCause& cause, double shape) const;  // m per unit of weight
  Eigen::VectorXd force() const;                                                        // N, through the shaft
  Eigen::VectorXd load() const;                                                         // m, not filtered
  const Eigen::VectorXd& measured() const { return measured_; }  // m, the load ahead of its motor

 private:
  EncoderDifference(const std::vector<Log>& logs, const machine::AxisModel& axis, const SignalSettings& settings);
  Eigen::VectorXd stacked(const std::vector<std::vector<double>>& of_each) const;
  // m, less what the file's shaft makes of the force.
  Eigen::VectorXd beyond_file(const machine::AxisModel& axis) const;

  LogRows rows_;  // of the motor's motion
  std::vector<ShaftRun> runs_;
  Eigen::VectorXd measured_, target_;
  std::vector<Eigen::VectorXd> nuisances_;
};

}  // namespace stiction::host
