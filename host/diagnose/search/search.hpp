// Which candidates the residual force needs: orthogonal matching over groups of regressors with their nonlinear
// parameters scanned inside, joint refits, exchange, and a try to drop each (Billings 2013, ch. 3, over groups). Among
// terms the score is that of forward selection by extended BIC; which stay, judgement.hpp says.
// What dominates the residual is found on the rows as they are, the rest beside it on whitened ones (whitening.hpp).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/search/judgement.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct Term {
  std::size_t candidate;  // of candidates()
  double shape;
  Eigen::VectorXd coefficients;
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

// `target`: the residual force of the rows. `context` gets the pitches that were found. `refuted`: candidates that
// other records spoke against, and that are no choice here.
SearchResult search_causes(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context,
                           std::span<const std::size_t> refuted = {});

}  // namespace stiction::host
