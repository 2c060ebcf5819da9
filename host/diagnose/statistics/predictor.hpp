// What a row of a noise is expected to be after the rows before it: a weight for each of the last few rows, and one for
// the mean of each span before them, twice as long as the one after it (a heterogeneous autoregression: Corsi, J.
// Financial Econometrics 7, 2009). So few weights hold what changes from row to row and what wanders for seconds: by
// eight rows alone a wandering force was taken for up to forty times less than it was.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

namespace stiction::host {

enum class Memory { of_rows, of_spans };

class Predictor {
 public:
  // Expects 0.
  Predictor() = default;
  // Least squares over the rows of a `noise`, with silence before and behind each log (Yule and Walker's equations).
  // `logs`: first row of each; `memory`: of the last rows alone, or of as many spans before them as the noise needs.
  Predictor(const Eigen::VectorXd& noise, std::span<const std::size_t> logs, Memory memory);

  bool empty() const { return rows_.empty(); }
  // Rows at a log's start that have too little before them.
  std::size_t first() const { return rows_.size(); }
  // The rows of one log less what they are expected to be.
  Eigen::VectorXd errors(const Eigen::VectorXd& log) const;
  // The transpose of that.
  Eigen::VectorXd transposed(const Eigen::VectorXd& errors) const;
  // What row `i` is expected to be. `values`: at least the rows before it; `sums`: of the rows before each, one more.
  double expected(std::size_t i, const Eigen::VectorXd& values, const Eigen::VectorXd& sums) const;
  // Square of the errors' gain at `cycles` a row.
  double gain_square(double cycles) const;

 private:
  struct Span {
    std::size_t nearest, furthest;  // rows back
    double weight;                  // of their mean
  };
  static std::vector<Span> spans_up_to(std::size_t furthest);
  bool holds(double innovation, double variance, std::size_t length) const;
  void take(const std::vector<Span>& spans);

  std::vector<double> rows_;  // weight of the row k + 1 rows back
  std::vector<Span> means_;
  // The same as steps of the weight over the rows back: each takes the sum of all rows that are so many back or more.
  struct Step {
    std::size_t back;
    double height;
  };
  std::vector<Step> steps_;
};

}  // namespace stiction::host
