// Which candidates the residual force needs: orthogonal matching over groups of regressors with their nonlinear
// parameters scanned inside, joint refits, exchange, and a try to drop each (Billings 2013, ch. 3, over groups). A term
// stays when blocks of rows agree on it: Wald test with covariance clustered by blocks below 0.01 over the number of
// candidates, and at least one percent off the cross-validated residual, not owed to a single event.
// What dominates the residual is found on the rows as they are, the rest beside it on whitened ones (whitening.hpp).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/evidence.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// What the data say of one term beside the others.
struct Judgement {
  double p_value = 1.0;  // that its weights are zero, times what was tried for its nonlinear parameter
  double gain = 0.0;     // share of the cross-validated residual that it takes away
  double first_half = 0.0, second_half = 0.0;  // its size found in each half of the rows, over that in all
  double first_error = 0.0, second_error = 0.0;
  std::optional<std::string> objection;  // why it does not stay
};

struct Term {
  std::size_t candidate;  // of candidates()
  double nonlinear;
  Eigen::VectorXd weights;
  Eigen::MatrixXd covariance;  // of the weights, and of the nonlinear parameter behind them
  double explains = 0.0;       // share of the target's square, given the others
  Judgement judgement;
  bool whitened = false;                  // found on whitened rows
  std::vector<std::size_t> alternatives;  // candidates that do as well in its place, as far as the blocks tell
};

struct Discarded {
  std::size_t candidate;
  std::string why;
  bool nearly = false;  // not quite significant: better data may name it
};

struct SearchResult {
  std::vector<Term> terms;  // by what each explains
  std::vector<Discarded> discarded;
  Eigen::VectorXd residual;  // N, of the rows, with all terms
  double correlation = 1.0;  // rows
  std::size_t blocks = 0;
};

// `target`: the residual force of the rows. `scene` gets the pitches that were found.
SearchResult search_causes(const LogRows& rows, const Eigen::VectorXd& target, Scene& scene,
                           const std::function<void()>& progress = {});

// The rows' column group of a candidate: `shared_columns` as one for all records, and with those that have weights of
// their own in each record in the rows of that one alone.
std::vector<Eigen::VectorXd> shared_columns(const LogRows& rows, const Scene& scene, const Candidate& candidate,
                                            double nonlinear);
std::vector<Eigen::VectorXd> group_columns(const LogRows& rows, const Scene& scene, const Candidate& candidate,
                                           double nonlinear);

}  // namespace stiction::host
