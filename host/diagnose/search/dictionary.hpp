// All that a search may choose from: every candidate at each value of its nonlinear parameter that is tried, with its
// columns over the rows; and what a set of them is worth: its evidence (marginal.hpp) and how likely it was beforehand.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/diagnose/statistics/marginal.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct Atom {
  std::size_t candidate;  // of candidates()
  double shape;
  Group group;
  double log_prior = 0.0;  // that it is there, against none
};

class Dictionary {
 public:
  using ActiveSet = std::vector<const Atom*>;

  // Those of the candidates that are not periodic. `target`: N, of the rows; `context` gets the lines that are found.
  Dictionary(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context);

  static ColumnIndices columns_of(const ActiveSet& set);
  static bool has(const ActiveSet& set, std::size_t candidate);
  static ActiveSet without(ActiveSet set, std::size_t term);
  Eigen::VectorXd residual(const ActiveSet& set) const;  // N, of the rows, not whitened

  // The noise is what the set leaves; where more may be found yet, what all candidates together leave beside it:
  // `absorbed`.
  void whiten(const ActiveSet& set, bool absorbed);
  // Looks for lines in what the set leaves, for options of the periodic candidates. What was found or refined before is
  // dropped, but for what is in the set and what is `known`.
  void scan_lines(const ActiveSet& set, const ActiveSet& known);

  Posterior posterior(const ActiveSet& set) const;
  // Log likelihood of the set with the noise that it leaves, less its price: what tells apart sets that leave different
  // noise; nats, but for a constant.
  double with_own_noise(const ActiveSet& set) const;
  // The same but for the rows' weights, which stay those of the search's noise: what tells a set from one with less in
  // it. That few rows that are far out are noise is not said anew by a set that leaves them there.
  double with_own_spectrum(const ActiveSet& set) const;
  // Log odds of the set against nothing, nats.
  double score(const ActiveSet& set) const;

  struct Option {
    const Atom* atom = nullptr;
    double score = 0.0;  // log odds of it against its absence, beside the rest, nats
  };
  // The candidate's atom with the highest odds `beside` a set, of which `of_beside` is the posterior; none where none
  // is possible.
  std::optional<Option> best_of(std::size_t candidate, const ActiveSet& beside, const Posterior& of_beside) const;
  // Log odds of the best of each of the candidates `names`, as best_of() beside none, were this the `record`; minus
  // infinity where none is possible. Lines and places are looked for in that record. `allowed`: in a
  // record like the search's own what cannot be by sign or size may count as well: one with more of it could say it.
  enum class Weights { possible, all };
  std::vector<double> names_in(const ExactRecord& record, const std::vector<std::size_t>& names, Weights allowed);
  // From now on without the logs number `part`, `part` + `parts`, ..., in whitened rows, by the noise that the set
  // leaves in the others; options and replays are those of all logs.
  void leave_out(const ActiveSet& set, std::size_t part, std::size_t parts);
  void take_all();
  // Drops what was found and refined since the start but for what is `known`, and gives each option its price as the
  // context has it now.
  void begin_again(const ActiveSet& known);
  // The `option` with its nonlinear parameter between the values of the grid; `beside` and `of_beside` as above.
  Option refined(Option option, const ActiveSet& beside, const Posterior& of_beside);

 protected:
  const LogRows& rows_;
  SearchContext& scene_;
  Eigen::VectorXd counts_;    // of the rows, 0 or 1
  double correlation_ = 1.0;  // rows, of the residual, whitened
  Evidence evidence_;         // whitened
  Evidence plain_;            // never whitened: for what a term takes off the force

 private:
  std::vector<double> values_of(const Candidate& candidate, bool scanned) const;
  void add_options(bool scanned);
  void drop_all_but(const ActiveSet& kept);
  void give_columns(const std::vector<Atom*>& options);
  void respond_under(const Eigen::VectorXd& noise);
  bool possible(const Atom& atom, const ActiveSet& beside, const Posterior& of_beside, double size) const;
  bool resolved(const Atom& atom, const Eigen::VectorXd& weights) const;
  std::optional<Option> at_shape(std::size_t candidate, double shape, const ActiveSet& beside,
                                 const Posterior& of_beside);
  std::vector<Atom> tried_in(const LogRows* other, std::size_t candidate);
  Whitening noise_in(const Eigen::VectorXd& left) const;
  Eigen::VectorXd settled_residual(const ActiveSet& set) const;
  Eigen::VectorXd absorbed_by_all(const ActiveSet& set) const;

  std::vector<std::unique_ptr<Atom>> options_;
  std::size_t on_grid_ = 0;  // of the options: those of candidates that are not periodic, as they were tried first
  Sizes sizes_;              // N rms, of a group's force
  bool left_out_ = false;    // some of the logs
  double disturbance_;       // square of the force under which candidates replay
};

}  // namespace stiction::host
