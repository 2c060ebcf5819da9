// What makes a coloured residual white: the prediction errors of an autoregressive model of it (Yule-Walker equations,
// solved by Levinson and Durbin). Least squares on whitened rows weighs each frequency by how little noise it carries,
// so that a push of milliseconds is not drowned by a force that wanders for seconds (Aitken 1936; Cochrane, Orcutt
// 1949).
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace stiction::host {

class Whitening {
 public:
  // Leaves everything as it is.
  Whitening() = default;
  // Of a residual in rows of several logs; `logs`: first row of each.
  Whitening(const Eigen::VectorXd& residual, std::span<const std::size_t> logs);

  // Each white row counts as many times as `weight` says from now on: the inverse of the noise's deviation there.
  void weigh(Eigen::VectorXd weight) { weight_ = std::move(weight); }

  const Eigen::VectorXd& weight() const { return weight_; }  // empty: 1

  // Whether it changes anything.
  explicit operator bool() const { return !predictor_.empty(); }
  // A column of all rows, whitened; the rows at each log's start that have too little before them are 0.
  Eigen::VectorXd operator()(const Eigen::VectorXd& column) const;
  // The transpose of that: (W'c)'d = c'(W d).
  Eigen::VectorXd transposed(const Eigen::VectorXd& column) const;
  // White values of one record coloured as the residual was: the inverse of whitening, from rest.
  Eigen::VectorXd coloured(const Eigen::VectorXd& white) const;
  // Square of the gain at `cycles` a row.
  double gain_square(double cycles) const;
  // The same noise in rows of other logs at the same rate, none of them weighed.
  Whitening over(std::span<const std::size_t> logs) const {
    auto other = *this;
    other.logs_.assign(logs.begin(), logs.end());
    other.weight_.resize(0);
    return other;
  }

 private:
  std::vector<std::size_t> logs_;
  std::vector<double> predictor_;  // of a row from those before it
  Eigen::VectorXd weight_;         // of each row; empty: 1
};

}  // namespace stiction::host
