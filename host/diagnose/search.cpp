#include "host/diagnose/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "host/diagnose/candidate_columns.hpp"
#include "host/diagnose/refinement.hpp"
#include "host/diagnose/scene_lines.hpp"
#include "sim/plant/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t most_terms = 8;
constexpr double least_share = 2e-3;  // of the residual's variance: what is less is no cause that a part would show
// Of the residual's variance: beside what takes more, the residual is no model of the noise, and what is whitened by it
// would get the weight of noise.
constexpr double dominant = 0.25;
constexpr double strong_evidence = 6.0;  // twice the logarithm of a Bayes factor
constexpr double less_disturbed = 0.7;
constexpr double cluster_lengths = 6.0;  // correlation lengths of the whitened residual in a cluster

struct Option {
  std::size_t candidate;
  double nonlinear;
  ColumnIndices columns;
};
using Set = std::vector<const Option*>;

std::vector<RowBlock> blocks_for(const LogRows& rows, double correlation) {
  const auto n = static_cast<double>(rows.rows());
  const double shortest = std::clamp(6.0 * correlation, n / 200.0, n / 30.0);
  return blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(shortest) + 1);
}

// Why a refined term is no effect that a machine can have.
std::optional<std::string> impossible(const Scene& scene, const Term& term) {
  const auto& candidate = candidates()[term.candidate];
  if (!candidate.possible(scene, term.nonlinear, term.weights))
    return "beside the other causes it fits with a sign or a size that it cannot have";
  if (candidate.outside()) return {};
  Finding finding;
  finding.effect.name = candidate.name;
  candidate.describe(scene, term.nonlinear, term.weights, term.covariance, finding);
  try {
    sim::check_effect(finding.effect);
  } catch (const sim::EffectError& error) {
    return error.what();
  }
  return {};
}

class Search {
 public:
  Search(const LogRows& rows, const Eigen::VectorXd& target, Scene& scene)
      : rows_(rows),
        scene_(scene),
        correlation_(correlation_length(target, rows.logs())),
        evidence_(target, blocks_for(rows, std::min(correlation_, 0.1 / rows.period(0)))),
        plain_(target, evidence_.row_blocks()),
        disturbance_(target.squaredNorm()) {
    add_options(false);
  }

  SearchResult run();

 private:
  // The options of all candidates that are periodic, or that are not.
  void add_options(bool periodic) {
    std::vector<Option*> added;
    for (std::size_t c = 0; c < candidates().size(); ++c) {
      if (candidates()[c].periodic != periodic) continue;
      for (const double value : candidates()[c].grid(scene_))
        added.push_back(options_.emplace_back(std::make_unique<Option>(Option{c, value, {}})).get());
    }
    give_columns(added);
  }
  void give_columns(const std::vector<Option*>& options) {
    std::vector<CandidateAt> trials;
    for (const auto* option : options) trials.push_back({&candidates()[option->candidate], option->nonlinear});
    const auto groups = group_columns(rows_, scene_, trials);
    for (std::size_t k = 0; k < groups.size(); ++k) {
      options[k]->columns.resize(groups[k].size());
      std::iota(options[k]->columns.begin(), options[k]->columns.end(), evidence_.add(groups[k]));
      plain_.add(groups[k]);
    }
  }

  Eigen::VectorXd residual(const Set& set) const {
    const auto columns = columns_of(set);
    return evidence_.residual(columns, evidence_.fit(columns).weights);
  }
  // The noise is what the set leaves.
  void whiten(const Set& set) {
    const Eigen::VectorXd noise = residual(set);
    const Whitening whitening(noise, rows_.logs());
    correlation_ = correlation_length(whitening(noise), rows_.logs());
    evidence_.whiten(whitening, static_cast<std::size_t>(std::ceil(cluster_lengths * correlation_)));
    respond_under(noise);
  }
  // Replays anew where the force that disturbs them turned out to be a good deal less: causes were found in it.
  void respond_under(const Eigen::VectorXd& noise) {
    if (!scene_.disturb || noise.squaredNorm() > less_disturbed * disturbance_) return;
    disturbance_ = noise.squaredNorm();
    scene_.disturb(noise);
    std::vector<Option*> replayed;
    for (const auto& option : options_)
      if (candidates()[option->candidate].replays) replayed.push_back(option.get());
    give_columns(replayed);
  }

  // Lines in what the set leaves; those in the set stay.
  void scan_lines(const Set& set) {
    find_lines(rows_, residual(set), evidence_.whitening(), scene_);
    add_options(true);
  }

  static ColumnIndices columns_of(const Set& set) {
    ColumnIndices all;
    for (const auto* option : set) all.insert(all.end(), option->columns.begin(), option->columns.end());
    return all;
  }
  static bool has(const Set& set, std::size_t candidate) {
    return std::any_of(set.begin(), set.end(), [&](const auto* o) { return o->candidate == candidate; });
  }

  bool settled(const Option* option) const {
    return std::find(settled_.begin(), settled_.end(), option->candidate) != settled_.end();
  }

  // Number of independent values of the nonlinear parameter that were tried.
  double trials(std::size_t candidate) const {
    if (const auto scan = candidates()[candidate].scan)
      return static_cast<double>(std::max<std::size_t>(scan(scene_).trials, 1));
    return std::max(candidates()[candidate].trials, candidates()[candidate].nonlinear ? 3.0 : 1.0);
  }
  double effective_rows() const { return std::max(static_cast<double>(evidence_.rows()) / correlation_, 20.0); }
  // A nonlinear parameter on a grid must show strongly (Kass, Raftery 1995): a drift that settles at once is a level.
  // One that is looked for in a scan costs its trials. What no name fits must show strongly beside what has one.
  double penalty(std::size_t candidate, std::size_t columns) const {
    const bool fitted = candidates()[candidate].nonlinear && candidates()[candidate].scan == nullptr;
    return static_cast<double>(columns) * std::log(effective_rows()) +
           (fitted ? strong_evidence : 2.0 * std::log(trials(candidate))) +
           (candidates()[candidate].outside() ? strong_evidence : 0.0);
  }
  // n_eff ln(square) and the price of the columns (extended BIC: Chen, Chen 2008).
  double score(const Set& set) const {
    const auto columns = columns_of(set);
    double price = 0.0;
    for (const auto* option : set) price += penalty(option->candidate, option->columns.size());
    return effective_rows() * std::log(std::max(evidence_.fit(columns).left, 1e-300)) + price;
  }
  bool all_possible(const Set& set) const {
    const auto weights = evidence_.fit(columns_of(set)).weights;
    Eigen::Index at = 0;
    for (const auto* option : set) {
      const auto count = static_cast<Eigen::Index>(option->columns.size());
      if (!candidates()[option->candidate].possible(scene_, option->nonlinear, weights.segment(at, count)))
        return false;
      at += count;
    }
    return true;
  }

  const Option* best_of(std::size_t candidate, const Set& beside) const {
    const Option* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& option : options_) {
      if (option->candidate != candidate) continue;
      auto set = beside;
      set.push_back(option.get());
      const double left = score(set);  // options of one candidate may differ in columns
      if (left >= least || !all_possible(set)) continue;
      least = left;
      best = option.get();
    }
    return best;
  }
  // Every term's nonlinear parameter anew, given the others.
  void profile(Set& set) const {
    for (int round = 0; round < 2; ++round)
      for (std::size_t k = 0; k < set.size(); ++k) {
        auto others = set;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        if (const auto* better = best_of(set[k]->candidate, others)) set[k] = better;
      }
  }
  void improve(Set& set) {
    profile(set);
    exchange(set);
    while (merge(set)) profile(set);
    while (drop(set)) profile(set);
  }
  bool exchange(Set& set) const;
  bool merge(Set& set) const;
  bool grow(Set& set, double least_taken = 0.0);
  bool drop(Set& set);
  Judgement judge(const Set& set, std::size_t term) const;
  void note(std::size_t candidate, const Judgement& judgement);
  std::vector<std::size_t> alternatives(const Set& set, std::size_t term) const;

  const LogRows& rows_;
  Scene& scene_;
  double correlation_ = 1.0;          // rows, of the residual, whitened or not
  Evidence evidence_;                 // whitened in the second part of a run
  Evidence plain_;                    // never whitened: for what a term takes off the force
  double disturbance_;                // square of the force under which candidates replay
  std::vector<std::size_t> settled_;  // candidates that stood before it
  std::vector<std::unique_ptr<Option>> options_;
  std::size_t rounds_ = 0;
  std::vector<Discarded> discarded_;
};

// A term for another candidate, where that scores better and would stay.
bool Search::exchange(Set& set) const {
  double least = score(set);
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (settled(set[k])) continue;
    auto others = set;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    for (std::size_t c = 0; c < candidates().size(); ++c) {
      if (has(set, c)) continue;
      const auto* option = best_of(c, others);
      if (option == nullptr) continue;
      auto trial = others;
      trial.push_back(option);
      profile(trial);
      if (const double s = score(trial); s < least - 1.0 && !judge(trial, trial.size() - 1).objection) {
        set = trial;
        exchange(set);
        return true;
      }
    }
  }
  return false;
}

// Two terms for one other, where that scores better: a force constant is mass, Coulomb and viscous friction together.
bool Search::merge(Set& set) const {
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
        if (score(trial) > score(set) - 1.0 || judge(trial, trial.size() - 1).objection) continue;
        set = trial;
        return true;
      }
    }
  return false;
}

Judgement Search::judge(const Set& set, std::size_t term) const {
  auto others = set;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(term));
  return judge_columns(evidence_, plain_, columns_of(others), set[term]->columns, trials(set[term]->candidate));
}

void Search::note(std::size_t candidate, const Judgement& judgement) {
  const auto known =
      std::find_if(discarded_.begin(), discarded_.end(), [&](const Discarded& d) { return d.candidate == candidate; });
  const Discarded now{candidate, *judgement.objection, judgement.nearly};
  if (known == discarded_.end())
    discarded_.push_back(now);
  else
    *known = now;
}

// Adds the best term that stands, or the best two that stand together: terms can mask one another. `least_taken`: share
// of the residual's square that they must take.
bool Search::grow(Set& set, double least_taken) {
  struct Trial {
    Set set;
    double score;
  };
  std::vector<Trial> trials;
  std::vector<const Option*> best;
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
  const auto takes_enough = [&](const Set& with) {
    return 1.0 - evidence_.fit(columns_of(with)).left / before >= least_taken;
  };
  for (auto& trial : trials) {
    if (!takes_enough(trial.set)) continue;
    if (trial.score > score(set)) break;
    const auto judgement = judge(trial.set, trial.set.size() - 1);
    if (!judgement.objection) {
      set = trial.set;
      return true;
    }
    note(trial.set.back()->candidate, judgement);
  }
  std::vector<Trial> pairs;
  for (std::size_t i = 0; i < best.size(); ++i)
    for (std::size_t j = i + 1; j < best.size(); ++j) {
      auto trial = set;
      trial.push_back(best[i]);
      trial.push_back(best[j]);
      if (all_possible(trial)) pairs.push_back({trial, score(trial)});
    }
  std::sort(pairs.begin(), pairs.end(), by_score);
  if (pairs.empty() || pairs.front().score > score(set) || !takes_enough(pairs.front().set)) return false;
  auto& pair = pairs.front().set;
  for (std::size_t k = set.size(); k < pair.size(); ++k)
    if (judge(pair, k).objection) return false;
  set = pair;
  return true;
}

bool Search::drop(Set& set) {
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (settled(set[k])) continue;
    const auto judgement = judge(set, k);
    if (!judgement.objection) continue;
    note(set[k]->candidate, judgement);
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(k));
    return true;
  }
  return false;
}

// Candidates that in the term's place leave a residual that the blocks cannot tell from its own.
std::vector<std::size_t> Search::alternatives(const Set& set, std::size_t term) const {
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
  const auto judge_new = [&](const Set& set) {
    for (std::size_t k = 0; k < set.size(); ++k)
      if (!judged.contains(set[k]->candidate)) judged[set[k]->candidate] = judge(set, k);
  };
  // What dominates, on the rows as they are.
  Set set;
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
  SearchResult result;
  for (std::size_t k = 0; k < set.size(); ++k) {
    Term term{set[k]->candidate, set[k]->nonlinear,   {}, {}, 0.0, judged.at(set[k]->candidate),
              !settled(set[k]),  alternatives(set, k)};
    auto others = set;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    term.explains = (plain_.fit(columns_of(others)).left - plain_.fit(columns_of(set)).left) / plain_.total();
    if (term.explains < least_share) {
      discarded_.push_back(
          {term.candidate, fmt::format("takes {:.2g} % off the residual force's variance; expected at least {:g} %",
                                       100.0 * std::max(term.explains, 0.0), 100.0 * least_share)});
      continue;
    }
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

SearchResult search_causes(const LogRows& rows, const Eigen::VectorXd& target, Scene& scene) {
  return Search(rows, target, scene).run();
}

}  // namespace stiction::host
