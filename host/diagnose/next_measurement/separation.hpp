// How far apart two explanations of a record are expected to be, before it is recorded: the part of one's force that
// the other and all nuisances, fitted at their best, cannot imitate, over the noise. Its largest minimum is the
// T-optimal experiment (Atkinson, Fedorov: Biometrika 62, 1975).
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/diagnose/search/search.hpp"

namespace stiction::host {

// A cause with its values.
struct Explanation {
  std::size_t candidate;  // of candidates()
  double shape;
  Eigen::VectorXd coefficients;
};
inline Explanation explanation_of(const Term& term) { return {term.candidate, term.shape, term.coefficients}; }

// Records, real or simulated, with what candidates may know of them. Keeps what one Separation has made of them.
struct Records {
  const LogRows& rows;
  const SearchContext& context;
  mutable std::map<std::pair<std::size_t, double>, std::vector<Eigen::VectorXd>> columns{};  // whitened
  mutable Eigen::VectorXd trust{};
};

// The force (N) of `cause` with its values, of each row of the `records`.
Eigen::VectorXd force_of(const Records& records, const Explanation& cause);

class Separation {
 public:
  // `residual`: what the found causes leave of the force in the present rows (N); the noise of other rows is taken to
  // be of its kind.
  Separation(const LogRows& rows, const Eigen::VectorXd& residual);

  // The candidate's values that fit `target` (N) best beside `others`; none: it cannot be what these records hold.
  std::optional<Explanation> best_fit(const Records& records, const Eigen::VectorXd& target, std::size_t candidate,
                                      std::span<const Explanation> others) const;

  // Standard errors by which such records are expected to prefer the causes `truth` to the causes `rival` (none:
  // nothing) where `truth` act; `others` act beside either. A rival alone takes the values that imitate best, of
  // several the weights do. Nuisances are those of held-out data: the level of Coulomb friction and a constant force of
  // each record.
  double expected(const Records& records, std::span<const Explanation> truth, std::span<const Explanation> rival,
                  std::span<const Explanation> others) const;
  // What these standard errors are of: the part of the force of `truth` in the whitened rows of `records` that neither
  // `rival`, nor `others`, nor a nuisance imitates, over the noise.
  Eigen::VectorXd separating_part(const Records& records, std::span<const Explanation> truth,
                                  std::span<const Explanation> rival, std::span<const Explanation> others) const;
  // Share of `target`'s square (whitened) that causes take away at their best weights. `records`: of the trajectory.
  double explained(const Records& records, const Eigen::VectorXd& target, std::span<const Explanation> causes) const;

 private:
  // N of the whitened rows.
  Eigen::VectorXd unimitated(const Records& records, std::span<const Explanation> truth,
                             std::span<const Explanation> rival, std::span<const Explanation> others) const;
  SearchContext scanned(const Records& records, const Eigen::VectorXd& force) const;
  std::vector<double> values_of(const Records& records, std::size_t candidate, const Eigen::VectorXd& force) const;
  Eigen::VectorXd white(const LogRows& rows, const Eigen::VectorXd& column) const;
  const Eigen::VectorXd& trust(const Records& records) const;
  const std::vector<Eigen::VectorXd>& white_columns(const Records& records, std::size_t candidate, double shape) const;

  Whitening whitening_;
  double noise_ = 0.0;      // N rms
  double deviation_ = 0.0;  // N, of whitened rows as if each said something of its own
};

}  // namespace stiction::host
