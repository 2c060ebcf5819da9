// All that a search may choose from: every candidate at each value of its nonlinear parameter that is tried, with its
// columns over the rows; and what a set of them is worth.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct Atom {
  std::size_t candidate;  // of candidates()
  double shape;
  ColumnIndices columns;
};

class Dictionary {
 public:
  using ActiveSet = std::vector<const Atom*>;

  // Those of the candidates that are not periodic. `target`: N, of the rows; `context` gets the lines that are found;
  // `refuted`: candidates that are left out.
  Dictionary(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context,
             std::span<const std::size_t> refuted);

  static ColumnIndices columns_of(const ActiveSet& set);
  static bool has(const ActiveSet& set, std::size_t candidate);
  Eigen::VectorXd residual(const ActiveSet& set) const;  // N, of the rows, not whitened

  // The noise is what the set leaves.
  void whiten(const ActiveSet& set);
  // Looks for lines in what the set leaves, for options of the periodic candidates; those in the set stay.
  void scan_lines(const ActiveSet& set);

  // Number of independent values of the nonlinear parameter that were tried.
  double trials(std::size_t candidate) const;
  // n_eff ln(square) and the price of the columns (extended BIC: Chen, Chen 2008); the less the better.
  double score(const ActiveSet& set) const;
  // Whether the set's weights have signs and sizes that the effects can have.
  bool all_possible(const ActiveSet& set) const;
  // The candidate's option that scores best beside the others; null where none is possible.
  const Atom* best_of(std::size_t candidate, const ActiveSet& beside) const;
  // Every term's nonlinear parameter anew, given the others.
  void profile(ActiveSet& set) const;

 protected:
  const LogRows& rows_;
  SearchContext& scene_;
  double correlation_ = 1.0;  // rows, of the residual, whitened or not
  Evidence evidence_;         // whitened in the second part of a run
  Evidence plain_;            // never whitened: for what a term takes off the force

 private:
  void add_options(bool periodic);
  void give_columns(const std::vector<Atom*>& options);
  void respond_under(const Eigen::VectorXd& noise);
  double effective_rows() const;
  double penalty(std::size_t candidate, std::size_t columns) const;

  std::span<const std::size_t> refuted_;
  std::vector<std::unique_ptr<Atom>> options_;
  double disturbance_;  // square of the force under which candidates replay
};

}  // namespace stiction::host
