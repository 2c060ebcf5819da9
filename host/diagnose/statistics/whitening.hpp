// What makes a coloured residual white: the prediction errors of an autoregressive model of it. Least squares on
// whitened rows weighs each frequency by how little noise it carries, so that a push of milliseconds is not drowned by
// a force that wanders for seconds (Aitken 1936; Cochrane, Orcutt 1949).
#pragma once

#include <Eigen/Dense>
#include <span>
#include <utility>
#include <vector>

#include "host/diagnose/statistics/noise_rows.hpp"
#include "host/diagnose/statistics/predictor.hpp"

namespace stiction::host {

class Whitening {
 public:
  // Leaves everything as it is.
  Whitening() = default;
  // Of a residual in `rows`: those at rest have a spectrum of their own, where they and the others are many.
  // `memory`: of its autoregression. Of spans it holds what wanders for seconds; by that noise a search finds little of
  // what its columns describe badly.
  Whitening(const Eigen::VectorXd& residual, const NoiseRows& rows, Memory memory = Memory::of_rows);

  // Each white row counts as many times as `weight` says from now on: the inverse of the noise's deviation there.
  void weigh(Eigen::VectorXd weight) { weight_ = std::move(weight); }

  const Eigen::VectorXd& weight() const { return weight_; }    // empty: 1
  const Eigen::VectorXd& at_rest() const { return at_rest_; }  // rows with a spectrum of their own: 1; empty: none

  // Whether it changes anything.
  explicit operator bool() const { return !in_motion_.empty(); }
  // A column of all rows, whitened; the rows at each log's start that have too little before them are 0.
  Eigen::VectorXd operator()(const Eigen::VectorXd& column) const;
  // The transpose of that: (W'c)'d = c'(W d).
  Eigen::VectorXd transposed(const Eigen::VectorXd& column) const;
  // White values coloured as the residual was: the inverse of whitening, from silence. `first`: the row of the first
  // of them, where they are those of a record.
  Eigen::VectorXd coloured(const Eigen::VectorXd& white, std::size_t first = 0) const;
  // Square of the gain at `cycles` a row, of rows in motion.
  double gain_square(double cycles) const { return in_motion_.gain_square(cycles); }
  // The same noise in rows of other logs at the same rate, all in motion, none of them weighed.
  Whitening over(std::span<const std::size_t> logs) const {
    auto other = *this;
    other.logs_.assign(logs.begin(), logs.end());
    other.weight_.resize(0);
    other.at_rest_.resize(0);
    return other;
  }

 private:
  // Without weights. `predictor`: of all rows.
  Eigen::VectorXd whitened(const Eigen::VectorXd& column, const Predictor& predictor) const;
  Eigen::VectorXd transposed(const Eigen::VectorXd& column, const Predictor& predictor) const;

  std::vector<std::size_t> logs_;
  Predictor in_motion_, still_;  // the second of rows at rest
  Eigen::VectorXd at_rest_;      // of each row, 1 or 0; empty: none is
  Eigen::VectorXd weight_;       // of each row; empty: 1
};

}  // namespace stiction::host
