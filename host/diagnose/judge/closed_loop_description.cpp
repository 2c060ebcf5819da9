#include "host/diagnose/judge/closed_loop_description.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/search/price.hpp"
#include "host/diagnose/search/refinement.hpp"
#include "host/diagnose/statistics/marginal.hpp"
#include "host/diagnose/statistics/noise_model.hpp"

namespace stiction::host {
namespace {

constexpr int passes_of_replays = 3;

enum class Keys { few, more };  // more: where the candidate has a freer description

std::vector<Finding> bare_findings(const SearchContext& context, const std::vector<Term>& terms, Keys keys) {
  std::vector<Finding> findings;
  for (const auto& term : terms) {
    const auto& candidate = candidates()[term.candidate];
    auto& finding = findings.emplace_back(*candidate.effect);
    finding.axis = context.axis.name;
    const bool freely = keys == Keys::more && candidate.describe_freely;
    (freely ? candidate.describe_freely : candidate.describe)(context, term.shape, term.coefficients, term.covariance,
                                                              finding);
  }
  return findings;
}

std::size_t keys_of(const std::vector<Finding>& findings) {
  std::size_t count = 0;
  for (const auto& finding : findings) count += finding.parameters.size();
  return count;
}

class Description {
 public:
  // `noise`: N, what all terms leave.
  Description(std::span<EffectResponse> responses, const LogRows& rows, const Eigen::VectorXd& target,
              const Eigen::VectorXd& noise, const SearchContext& context)
      : responses_(responses), rows_(rows), target_(target), noise_(noise), context_(context) {}

  // All terms as they are.
  ClosedLoopDescription taken(std::vector<Term> named, std::vector<Term> unnamed) {
    ClosedLoopDescription description{std::move(named), {}, std::move(unnamed), {}};
    run(description, noise_);
    return description;
  }

  ClosedLoopDescription grown(std::vector<Term> named, std::vector<Term> unnamed) {
    ClosedLoopDescription description;
    auto waiting = std::move(named);
    double leftover = 0.0;
    auto left = target_;
    // The first is the strongest that explains anything.
    while (description.terms.empty() && !waiting.empty()) {
      const auto strongest = std::max_element(waiting.begin(), waiting.end(),
                                              [](const Term& a, const Term& b) { return a.nats < b.nats; });
      leftover = of_strongest * strongest->nats;
      description.terms.push_back(std::move(*strongest));
      waiting.erase(strongest);
      left = describe(description);
      if (likelihood(left) - likelihood(target_) >= sure) break;
      std::move(description.terms.begin(), description.terms.end(), std::back_inserter(description.remainders));
      description.terms.clear();
      description.findings.clear();
      left = target_;
    }
    std::move(unnamed.begin(), unnamed.end(), std::back_inserter(waiting));
    for (;;) {
      const auto next = most_needed(waiting, left, leftover);
      if (next == waiting.size()) break;
      const bool has_name = !candidates()[waiting[next].candidate].outside();
      (has_name ? description.terms : description.unnamed).push_back(std::move(waiting[next]));
      waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(next));
      left = describe(description);
    }
    std::move(waiting.begin(), waiting.end(), std::back_inserter(description.remainders));
    return description;
  }

 private:
  Eigen::VectorXd force_of(const Term& term) const {
    return weighted_columns(rows_, context_, candidates()[term.candidate], term.shape, term.coefficients);
  }

  std::vector<RowBlock> blocks() const {
    return blocks_of(rows_.velocity, rows_.logs(), static_cast<std::size_t>(rows_.rows() / 60 + 1));
  }
  double likelihood(const Eigen::VectorXd& residual) const {
    return noise_log_likelihood(residual.cwiseProduct(rows_.counts()), rows_);
  }
  Evidence evidence_of(const Eigen::VectorXd& residual, const Eigen::VectorXd& noise) const {
    Evidence evidence(residual, blocks());
    evidence.whiten(noise_of(noise.cwiseProduct(rows_.counts()), rows_));
    return evidence;
  }

  // Fits the terms that the description has, those with a name in closed loop; returns what is left. What a coarse
  // description leaves is no noise: from the terms as they are, by the noise that they leave, and from where the force
  // as it is puts them, by the noise that this has left; the likelier counts. Under that noise what replays does so
  // anew.
  Eigen::VectorXd describe(ClosedLoopDescription& description) {
    auto terms = description.terms;
    terms.insert(terms.end(), description.unnamed.begin(), description.unnamed.end());
    auto as_it_is = terms;
    Eigen::VectorXd left = target_;
    for (const auto& term : terms) left -= force_of(term);
    left = settled(terms, std::move(left));
    auto of_force = settled(as_it_is, refine(rows_, Evidence(target_, blocks()), context_, as_it_is));
    if (likelihood(of_force) > likelihood(left)) terms = std::move(as_it_is), left = std::move(of_force);
    const auto named = static_cast<std::ptrdiff_t>(description.terms.size());
    description.terms.assign(terms.begin(), terms.begin() + named);
    description.unnamed.assign(terms.begin() + named, terms.end());
    return run(description, std::move(left));
  }

  // The terms' best fit by the noise that the one before has left; returns what is left.
  Eigen::VectorXd settled(std::vector<Term>& terms, Eigen::VectorXd left) const {
    const bool replays = context_.disturb && std::any_of(terms.begin(), terms.end(), [](const Term& term) {
                           return candidates()[term.candidate].replays;
                         });
    for (int pass = 0; pass < (replays ? passes_of_replays : 1); ++pass) {
      if (replays) context_.disturb(left);
      left = refine(rows_, evidence_of(target_, left), context_, terms);
    }
    return left;
  }

  // Moves the findings to where runs of the machine fit best; returns what they leave. `left`: what the terms leave.
  Eigen::VectorXd run(ClosedLoopDescription& description, Eigen::VectorXd left) {
    Eigen::VectorXd aside = Eigen::VectorXd::Zero(rows_.rows());
    for (const auto& term : description.unnamed) aside += force_of(term);
    const auto refined_with = [&](std::vector<Finding> findings) {
      return refine_in_closed_loop(std::move(findings), description.terms, responses_, rows_, target_ - aside, left,
                                   context_);
    };
    auto few = bare_findings(context_, description.terms, Keys::few),
         more = bare_findings(context_, description.terms, Keys::more);
    const auto further = static_cast<double>(keys_of(more) - keys_of(few));
    auto refined = refined_with(std::move(few));
    if (further > 0.0) {
      // Schwarz 1978.
      const double price = 0.5 * further * std::log(static_cast<double>(rows_.rows()));
      auto freely = refined_with(std::move(more));
      if (freely.response && likelihood(freely.left) > likelihood(refined.left) + price) refined = std::move(freely);
    }
    description.findings = std::move(refined.findings);
    for (std::size_t k = 0; k < description.terms.size(); ++k) {
      auto& term = description.terms[k];
      term.in_runs.reset();
      if (refined.response && described_by_runs(term))
        term.in_runs = {description.findings[k].row(), *refined.response};
    }
    return refined.left;
  }

  // Index of the term that is worth most beside the rest; their number where none is worth its price.
  std::size_t most_needed(const std::vector<Term>& waiting, const Eigen::VectorXd& left, double leftover) const {
    auto evidence = evidence_of(left, noise_);
    const auto sizes = sizes_beside(left);
    std::size_t best = waiting.size();
    double most = leftover + sure;
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      const auto group =
          add_group(evidence, group_columns(rows_, context_, candidates()[waiting[k].candidate], waiting[k].shape));
      const double nats = Posterior(evidence, sizes).gain_of(group).nats +
                          log_prior_of(context_, waiting[k].candidate, waiting[k].shape);
      if (nats > most) most = nats, best = k;
    }
    return best;
  }

  std::span<EffectResponse> responses_;
  const LogRows& rows_;
  const Eigen::VectorXd &target_, &noise_;
  const SearchContext& context_;
};

}  // namespace

ClosedLoopDescription describe_in_closed_loop(std::vector<Term> named, std::vector<Term> unnamed,
                                              std::span<EffectResponse> responses, const LogRows& rows,
                                              const Eigen::VectorXd& target, const Eigen::VectorXd& left,
                                              const SearchContext& context) {
  Description description(responses, rows, target, left, context);
  // Only what has a nonlinear parameter is described coarsely by its columns.
  const bool coarse = std::any_of(named.begin(), named.end(), [](const Term& term) {
    return candidates()[term.candidate].shape || candidates()[term.candidate].at_weight;
  });
  return responses.empty() || !coarse ? description.taken(std::move(named), std::move(unnamed))
                                      : description.grown(std::move(named), std::move(unnamed));
}

}  // namespace stiction::host
