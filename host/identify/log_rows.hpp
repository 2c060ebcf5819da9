// The rows of all logs of an identification: force and regressors, one below the other.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <span>
#include <vector>

#include "host/identify/motion.hpp"

namespace stiction::host {

class LogRows {
 public:
  LogRows() = default;  // of no record
  LogRows(std::vector<Motion> motions, const SignalSettings& settings);

  const std::vector<Motion>& motions() const { return motions_; }
  const std::vector<std::size_t>& logs() const { return logs_; }  // first row of each
  std::size_t end(std::size_t log) const {                        // past its last row
    return log + 1 < logs_.size() ? logs_[log + 1] : static_cast<std::size_t>(rows());
  }
  Eigen::Index rows() const { return force.size(); }
  double period(std::size_t log) const { return filters_[log].period(); }  // s, from row to row

  // A regressor: what `column` makes of each motion, filtered and stacked.
  Eigen::VectorXd stacked(const std::function<std::vector<double>(const Motion&)>& column) const;
  // Several at once, which takes less time.
  std::vector<Eigen::VectorXd> stacked_together(
      const std::function<std::vector<std::vector<double>>(const Motion&)>& columns) const;
  // The same without the filter: for what is no regressor, a mask or the time.
  Eigen::VectorXd sampled(const std::function<std::vector<double>(const Motion&)>& column) const;
  // The transpose of stacked(): of each motion, weights of samples from those of rows.
  std::vector<std::vector<double>> transposed(const Eigen::VectorXd& weights) const;
  // Motions of a simulation of the logs in `measured` read what those have read.
  void read_as(const LogRows& measured);
  // They read this: m, at each sample of each.
  void read_as(std::span<const std::vector<double>> read);
  // Leaves rows without weight: from now on force and regressors are zero where `counts` is 0 (one value a row, 0 or
  // 1).
  void weigh(Eigen::VectorXd counts);
  // The weight of each row.
  const Eigen::VectorXd& counts() const { return counts_; }
  // 1 for each row in which the set-point stays for a while, as in a dwell or between two motions, else 0; of logs
  // without set-points 0.
  std::span<const double> at_rest() const { return at_rest_; }

  // A regressor of one log, zero in the rows of the others.
  Eigen::VectorXd of_log(std::size_t log, const std::vector<double>& column) const;

  Eigen::VectorXd force, acceleration, velocity, time;
  Eigen::VectorXd weight;  // the samples' weights, filtered
  Eigen::VectorXd one;     // the regressor of the constant force: these weights, by what the force goes with

 private:
  std::vector<Motion> motions_;
  std::vector<RowFilter> filters_;
  std::vector<std::size_t> logs_;
  Eigen::VectorXd counts_;
  std::vector<double> at_rest_;
};

}  // namespace stiction::host
