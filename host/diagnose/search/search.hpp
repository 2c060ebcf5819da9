// Which candidates the residual force needs: the set with the highest odds, by adding, exchanging, merging and dropping
// (all that remain are fitted again each time), with nonlinear parameters refined before anything is added after them.
// Names compete with smooth functions that have none: what is certain and is no name's is what stays unexplained.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/search/judgement.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct Term {
  std::size_t candidate = 0;  // of candidates()
  double shape = 0.0;
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;  // of the weights, and of the nonlinear parameter behind them
  double size = 0.0;      // N rms, of its force beforehand: of a term without a name, whose weights nothing else holds
  double explains = 0.0;  // share of the target's square, given the others
  Judgement judgement;
  double nats = 0.0;         // log odds of it against its absence, beside the others
  double probability = 1.0;  // of this candidate, of all that could be in its place
  struct Alternative {
    std::size_t candidate;
    double probability;
  };
  // Where runs of the simulated machine describe it better than its columns.
  struct InRuns {
    machine::Effect effect;
    std::size_t response;  // of the records' simulations, the one whose hunting fits
  };
  std::optional<InRuns> in_runs;
  std::optional<NamedIn> without_each_log;  // none: of a single log, or without a name
  std::vector<Alternative> alternatives;    // other names that may be in its place, the likeliest first
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
  std::size_t exact_records = 0;  // simulated, of the machine as its file says, to see what is named in those; 0: none
};

// `target`: the residual force of the rows. `context` gets the pitches that were found.
SearchResult search_causes(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context);

}  // namespace stiction::host
