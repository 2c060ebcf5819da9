#include "host/diagnose/search/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "host/diagnose/search/dictionary.hpp"
#include "host/diagnose/search/refinement.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t most_terms = 8;
constexpr double least_share = 2e-3;  // of the residual's variance: what is less is no cause that a part would show
// Of the residual's variance: beside what takes more, the residual is no model of the noise, and what is whitened by it
// would get the weight of noise.
constexpr double dominant = 0.25;

// Why a refined term is no effect that a machine can have.
std::optional<std::string> impossible(const SearchContext& context, const Term& term) {
  const auto& candidate = candidates()[term.candidate];
  if (!candidate.possible(context, term.shape, term.coefficients))
    return "given the other causes, the fit has an impossible sign or size";
  if (candidate.outside()) return {};
  Finding finding(*candidate.effect);
  candidate.describe(context, term.shape, term.coefficients, term.covariance, finding);
  try {
    sim::check_effect(finding.row());
  } catch (const sim::EffectError& error) {
    return error.what();
  }
  return {};
}

class Search : private Dictionary {
 public:
  using Dictionary::Dictionary;

  SearchResult run();

 private:
  bool settled(const Atom* option) const {
    return std::find(settled_.begin(), settled_.end(), option->candidate) != settled_.end();
  }
  void improve(ActiveSet& set) {
    profile(set);
    exchange(set);
    while (merge(set)) profile(set);
    while (drop(set)) profile(set);
  }
  bool exchange(ActiveSet& set) const;
  bool merge(ActiveSet& set) const;
  bool grow(ActiveSet& set, double least_taken = 0.0);
  bool drop(ActiveSet& set);
  Judgement judge(const ActiveSet& set, std::size_t term) const;
  void note(std::size_t candidate, const Judgement& judgement);
  std::vector<std::size_t> alternatives(const ActiveSet& set, std::size_t term) const;
  double explained_by(const ActiveSet& set, std::size_t term) const;
  void drop_small(ActiveSet& set);

  std::vector<std::size_t> settled_;  // candidates that stood before it was whitened
  std::size_t rounds_ = 0;
  std::vector<Discarded> discarded_;
};

// A term for another candidate, where that scores better and would stay.
bool Search::exchange(ActiveSet& set) const {
  double least = score(set);
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (settled(set[k])) continue;
    auto others = set;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    for (std::size_t c = 0; c < candidates().size(); ++c) {
      if (c == set[k]->candidate || has(others, c)) continue;
      const auto* option = best_of(c, others);
      if (option == nullptr) continue;
      auto trial = others;
      trial.push_back(option);
      profile(trial);
      if (const double s = score(trial); s < least - 1.0 && !judge(trial, trial.size() - 1).rejection_reason) {
        set = trial;
        exchange(set);
        return true;
      }
    }
  }
  return false;
}

// Two terms for one other, where that scores better: a force constant is mass, Coulomb and viscous friction together.
bool Search::merge(ActiveSet& set) const {
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::size_t j = i + 1; j < set.size(); ++j) {
      if (settled(set[i]) || settled(set[j])) continue;
      auto others = set;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      for (std::size_t c = 0; c < candidates().size(); ++c) {
        if (has(set, c)) continue;
        const auto* option = best_of(c, others);
        if (option == nullptr) continue;
        auto trial = others;
        trial.push_back(option);
        if (score(trial) > score(set) - 1.0 || judge(trial, trial.size() - 1).rejection_reason) continue;
        set = trial;
        return true;
      }
    }
  return false;
}

Judgement Search::judge(const ActiveSet& set, std::size_t term) const {
  auto others = set;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(term));
  return judge_columns(evidence_, plain_, columns_of(others), set[term]->columns, trials(set[term]->candidate));
}

void Search::note(std::size_t candidate, const Judgement& judgement) {
  const auto known =
      std::find_if(discarded_.begin(), discarded_.end(), [&](const Discarded& d) { return d.candidate == candidate; });
  const Discarded now{candidate, *judgement.rejection_reason, judgement.nearly};
  if (known == discarded_.end())
    discarded_.push_back(now);
  else
    *known = now;
}

// Adds the best term that stands, or the best two that stand together: terms can mask one another. `least_taken`: share
// of the residual's square that they must take.
bool Search::grow(ActiveSet& set, double least_taken) {
  struct Trial {
    ActiveSet set;
    double score;
  };
  std::vector<Trial> trials;
  std::vector<const Atom*> best;
  for (std::size_t c = 0; c < candidates().size(); ++c) {
    if (has(set, c)) continue;
    const auto* option = best_of(c, set);
    if (option == nullptr) continue;
    best.push_back(option);
    auto trial = set;
    trial.push_back(option);
    trials.push_back({trial, score(trial)});
  }
  const auto by_score = [](const Trial& a, const Trial& b) { return a.score < b.score; };
  std::sort(trials.begin(), trials.end(), by_score);
  const double before = evidence_.fit(columns_of(set)).left;
  const auto takes_enough = [&](const ActiveSet& with) {
    return 1.0 - evidence_.fit(columns_of(with)).left / before >= least_taken;
  };
  for (auto& trial : trials) {
    if (!takes_enough(trial.set)) continue;
    if (trial.score > score(set)) break;
    const auto judgement = judge(trial.set, trial.set.size() - 1);
    if (!judgement.rejection_reason) {
      set = trial.set;
      return true;
    }
    note(trial.set.back()->candidate, judgement);
  }
  std::vector<Trial> pairs;
  for (std::size_t i = 0; i < best.size(); ++i)
    for (std::size_t j = i + 1; j < best.size(); ++j) {
      if (has({best[i]}, best[j]->candidate)) continue;  // they look alike
      auto trial = set;
      trial.push_back(best[i]);
      trial.push_back(best[j]);
      if (all_possible(trial)) pairs.push_back({trial, score(trial)});
    }
  std::sort(pairs.begin(), pairs.end(), by_score);
  if (pairs.empty() || pairs.front().score > score(set) || !takes_enough(pairs.front().set)) return false;
  auto& pair = pairs.front().set;
  for (std::size_t k = set.size(); k < pair.size(); ++k)
    if (judge(pair, k).rejection_reason) return false;
  set = pair;
  return true;
}

bool Search::drop(ActiveSet& set) {
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (settled(set[k])) continue;
    const auto judgement = judge(set, k);
    if (!judgement.rejection_reason) continue;
    note(set[k]->candidate, judgement);
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(k));
    return true;
  }
  return false;
}

// Share of the residual's square that a term explains, given the others of the set.
double Search::explained_by(const ActiveSet& set, std::size_t term) const {
  auto others = set;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(term));
  return (plain_.fit(columns_of(others)).left - plain_.fit(columns_of(set)).left) / plain_.total();
}

// Discards terms that explain too little, the least of them first: of two that can do each other's work neither
// explains anything given the other, and only one may go.
void Search::drop_small(ActiveSet& set) {
  while (!set.empty()) {
    std::size_t least = 0;
    for (std::size_t k = 1; k < set.size(); ++k)
      if (explained_by(set, k) < explained_by(set, least)) least = k;
    const double explains = explained_by(set, least);
    if (explains >= least_share) return;
    discarded_.push_back(
        {set[least]->candidate, fmt::format("explains {:.2g} % of the residual variance; expected at least {:g} %",
                                            100.0 * std::max(explains, 0.0), 100.0 * least_share)});
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

// Candidates that in the term's place leave a residual that the blocks cannot tell from its own.
std::vector<std::size_t> Search::alternatives(const ActiveSet& set, std::size_t term) const {
  std::vector<std::size_t> as_good;
  auto others = set;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(term));
  const auto without = evidence_.held_out(columns_of(others)), with = evidence_.held_out(columns_of(set));
  for (std::size_t c = 0; c < candidates().size(); ++c) {
    if (has(set, c) || candidates()[c].outside()) continue;
    const auto* option = best_of(c, others);
    if (option == nullptr) continue;
    auto trial = others;
    trial.push_back(option);
    const auto instead = evidence_.held_out(columns_of(trial));
    double gained = 0.0, of = 0.0, mean = 0.0, square = 0.0;
    const double n = static_cast<double>(with.size());
    for (std::size_t b = 0; b < with.size(); ++b) {
      of += without[b] - with[b];
      gained += without[b] - instead[b];
      mean += (instead[b] - with[b]) / n;
      square += (instead[b] - with[b]) * (instead[b] - with[b]) / n;
    }
    const double error = std::sqrt(std::max(square - mean * mean, 0.0) / (n - 1.0));
    if (gained > 0.7 * of && mean < 2.0 * error) as_good.push_back(c);
  }
  return as_good;
}

SearchResult Search::run() {
  std::map<std::size_t, Judgement> judged;
  const auto judge_new = [&](const ActiveSet& set) {
    for (std::size_t k = 0; k < set.size(); ++k)
      if (!judged.contains(set[k]->candidate)) judged[set[k]->candidate] = judge(set, k);
  };
  // What dominates, on the rows as they are.
  ActiveSet set;
  scan_lines(set);
  while (set.size() < most_terms && grow(set, dominant)) {
    scan_lines(set);
    improve(set);
    correlation_ = correlation_length(residual(set), rows_.logs());
    if (++rounds_ > 2 * most_terms) break;
  }
  judge_new(set);
  for (const auto* option : set) settled_.push_back(option->candidate);
  // Then what is small beside the noise, each frequency by how little noise it carries.
  whiten(set);
  scan_lines(set);
  while (set.size() < most_terms && grow(set)) {
    scan_lines(set);
    improve(set);
    whiten(set);
    if (++rounds_ > 4 * most_terms) break;
  }
  judge_new(set);
  // Where causes were found without it, what is left may be more physics rather than noise, and would get the weight
  // of noise: weights are then those of least squares as it is.
  if (!settled_.empty()) evidence_.whiten({});
  drop_small(set);
  SearchResult result;
  for (std::size_t k = 0; k < set.size(); ++k) {
    Term term{set[k]->candidate, set[k]->shape,       {}, {}, 0.0, judged.at(set[k]->candidate),
              !settled(set[k]),  alternatives(set, k)};
    term.explains = explained_by(set, k);
    result.terms.push_back(std::move(term));
  }
  result.residual = refine(rows_, evidence_, scene_, result.terms);
  // Terms that nearly cancel each other can end with values that they cannot have.
  for (std::size_t k = 0; k < result.terms.size();) {
    if (const auto why = impossible(scene_, result.terms[k])) {
      discarded_.push_back({result.terms[k].candidate, *why});
      result.terms.erase(result.terms.begin() + static_cast<std::ptrdiff_t>(k));
      result.residual = refine(rows_, evidence_, scene_, result.terms);
      k = 0;
    } else {
      ++k;
    }
  }
  for (const auto& d : discarded_)
    if (!candidates()[d.candidate].outside() &&
        std::none_of(result.terms.begin(), result.terms.end(),
                     [&](const Term& term) { return term.candidate == d.candidate; }))
      result.discarded.push_back(d);
  std::sort(result.terms.begin(), result.terms.end(),
            [](const Term& a, const Term& b) { return a.explains > b.explains; });
  result.correlation = correlation_;
  result.blocks = evidence_.blocks();
  return result;
}

}  // namespace

SearchResult search_causes(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context,
                           std::span<const std::size_t> refuted) {
  return Search(rows, target, context, refuted).run();
}

}  // namespace stiction::host
