// The evidence of linear models of the rows whose weights are integrated out: marginal likelihood of a set of groups of
// columns against none, in nats, of rows that are white with variance one. A group's weights are normal about zero; how
// large its force is beforehand, nobody knows to better than a factor, so that the evidence is the mean over sizes in
// even steps of their logarithm (MacKay 1992, "Bayesian interpolation"; Bishop 2006, section 3.5). A group that is not
// needed pays for what it could have explained, by as much as it has columns: nothing else limits their number.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "host/diagnose/statistics/evidence.hpp"

namespace stiction::host {

// Sizes of a group's force (N rms over the rows) that are tried.
struct Sizes {
  double smallest = 0.0, largest = 0.0;
};
// From where none would be seen to twice the residual (N, of all rows).
Sizes sizes_beside(const Eigen::VectorXd& residual);

// A group of columns of the evidence. `deviation`: of each weight, where the group's force has a size of 1 N rms.
struct Group {
  ColumnIndices columns;
  Eigen::VectorXd deviation;
};
// Adds columns (N per unit of weight, not whitened) to the evidence: a group whose weights are all as likely.
Group add_group(Evidence& evidence, const std::vector<Eigen::VectorXd>& columns);

// What some groups together make of the rows: the starting point for one more.
class Posterior {
 public:
  // `evidence`: whitened rows of variance one.
  Posterior(const Evidence& evidence, Sizes sizes);

  // With one group more, at its best size.
  void add(const Group& group);

  struct Gain {
    double nats = 0.0;  // log evidence with the group over without, its size integrated out
    double size = 0.0;  // N rms, the best
  };
  Gain gain_of(const Group& group) const;

  double nats() const { return nats_; }  // log evidence over that of no group
  // What of it is not the fit: the price of the groups' freedom, below zero.
  double price() const;
  const ColumnIndices& columns() const { return columns_; }
  const Eigen::VectorXd& weights() const { return weights_; }  // posterior mean, of columns()
  // Posterior mean of the weights that the columns() and `group` have together, the group's last, at this size.
  Eigen::VectorXd weights_with(const Group& group, double size) const;

 private:
  struct Beside {
    Eigen::MatrixXd cross;   // products with the columns that are in
    Eigen::MatrixXd gram;    // what is left of the group's own products beside them
    Eigen::VectorXd moment;  // and of those with the target
  };
  Beside beside(const Group& group) const;

  const Evidence& evidence_;
  Sizes sizes_;
  double nats_ = 0.0;
  ColumnIndices columns_;
  Eigen::VectorXd precision_;  // of the prior, of each column
  Eigen::VectorXd moment_, weights_;
  Eigen::MatrixXd gram_;
  Eigen::LLT<Eigen::MatrixXd> factor_;  // of gram and prior precision
};

}  // namespace stiction::host
