#include "host/diagnose/search/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "host/diagnose/search/calibration.hpp"
#include "host/diagnose/search/dictionary.hpp"
#include "host/diagnose/search/price.hpp"
#include "host/diagnose/search/refinement.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t most_terms = 10;
constexpr std::size_t most_rounds = 40;
constexpr std::size_t refined_each = 5;  // of the best options, before one of them is taken
constexpr std::size_t paired = 10;       // of the best options, where none is worth its price alone
constexpr double better = 0.5;           // nats: less is no reason to move
constexpr std::size_t most_instead = 4;  // names for a term without one: a wave has as many harmonics
constexpr std::size_t most_parts = 8;    // of the logs, each of which is left out once
constexpr double telling = 20.0;         // odds that exclude a name in the place of another
constexpr double least_probability = 1.0 / (1.0 + telling);

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
  // With the prices of records of the exact machine, where a name came out that has one.
  SearchResult run_calibrated();
  // Looks for causes with one log after the other left out, of more than a few with one part of them after the other;
  // and tells each term of the `result` that has a name in how many of these searches it is named.
  void search_without_each_log(SearchResult& result);

 private:
  std::vector<Option> options_beside(const ActiveSet& set, const Posterior& of_set) const;
  std::vector<Option> refined_best(const ActiveSet& set, const Posterior& of_set);
  ActiveSet searched_from(bool absorbed, const ActiveSet& known);
  bool grow(ActiveSet& set);
  bool grow_by_pair(ActiveSet& set, const std::vector<Option>& options);
  bool move_one(ActiveSet& set);
  bool merge(ActiveSet& set);
  bool name_instead(ActiveSet& set, const ActiveSet& known);
  void improve(ActiveSet& set);
  struct Worth {  // nats
    double by_one_noise, by_own_spectrum;
  };
  Worth worth(const ActiveSet& set, std::size_t term) const;
  Worth leftover(const ActiveSet& set) const;
  void name(const ActiveSet& set, std::size_t term, Term& as);
  void prune(ActiveSet& set);
  double explained_by(const ActiveSet& set, std::size_t term) const;
  std::vector<Term> terms_of(const ActiveSet& set);
  void discard(std::size_t candidate, std::string why, bool nearly);

  ActiveSet found_;
  std::vector<Discarded> discarded_;
  std::set<std::size_t> refused_;  // candidates that an axis cannot have as these records want them
};

// Each candidate's best beside the set, the likeliest first.
std::vector<Dictionary::Option> Search::options_beside(const ActiveSet& set, const Posterior& of_set) const {
  std::vector<Option> options;
  for (std::size_t c = 0; c < candidates().size(); ++c)
    if (!has(set, c) && !refused_.contains(c))
      if (const auto option = best_of(c, set, of_set)) options.push_back(*option);
  std::sort(options.begin(), options.end(), [](const Option& a, const Option& b) { return a.score > b.score; });
  return options;
}

std::vector<Dictionary::Option> Search::refined_best(const ActiveSet& set, const Posterior& of_set) {
  auto options = options_beside(set, of_set);
  for (std::size_t k = 0; k < std::min(refined_each, options.size()); ++k)
    options[k] = refined(options[k], set, of_set);
  std::sort(options.begin(), options.end(), [](const Option& a, const Option& b) { return a.score > b.score; });
  return options;
}

// What a term is worth against none: by the noise that the set leaves, and by the spectra that it leaves with the term
// and without it. By the first alone a force that wanders would be worth all that it takes from the noise's slow end.
Search::Worth Search::worth(const ActiveSet& set, std::size_t term) const {
  const auto others = without(set, term);
  return {score(set) - score(others), with_own_spectrum(set) - with_own_spectrum(others)};
}

// What a further term has to be worth beside the strongest: so much may be left of how that one was described.
Search::Worth Search::leftover(const ActiveSet& set) const {
  Worth strongest{0.0, 0.0};
  for (std::size_t k = 0; k < set.size(); ++k) {
    const auto own = worth(set, k);
    strongest = {std::max(strongest.by_one_noise, own.by_one_noise),
                 std::max(strongest.by_own_spectrum, own.by_own_spectrum)};
  }
  return {of_strongest * strongest.by_one_noise, of_strongest * strongest.by_own_spectrum};
}

bool Search::grow(ActiveSet& set) {
  const auto of_set = posterior(set);
  const auto options = refined_best(set, of_set);
  if (!options.empty() && options.front().score > leftover(set).by_one_noise) {
    set.push_back(options.front().atom);
    return true;
  }
  return grow_by_pair(set, options);
}

// Terms can mask one another: two that together are worth their price.
bool Search::grow_by_pair(ActiveSet& set, const std::vector<Option>& options) {
  double most = leftover(set).by_one_noise;
  ActiveSet best;
  for (std::size_t i = 0; i < std::min(paired, options.size()); ++i) {
    auto with_one = set;
    with_one.push_back(options[i].atom);
    const auto of_one = posterior(with_one);
    for (std::size_t j = 0; j < std::min(2 * paired, options.size()); ++j) {
      if (has(with_one, options[j].atom->candidate)) continue;
      const auto other = best_of(options[j].atom->candidate, with_one, of_one);
      if (!other || options[i].score + other->score <= most) continue;
      most = options[i].score + other->score;
      best = with_one;
      best.push_back(other->atom);
    }
  }
  if (best.empty()) return false;
  set = best;
  return true;
}

// A term for another candidate, for another of its own values, or for none.
bool Search::move_one(ActiveSet& set) {
  const double now = score(set);
  for (std::size_t k = 0; k < set.size(); ++k) {
    const auto others = without(set, k);
    const auto of_others = posterior(others);
    double of_rest = of_others.nats();
    for (const auto* atom : others) of_rest += atom->log_prior;
    if (of_rest > now) {
      set = others;
      return true;
    }
    auto options = options_beside(others, of_others);
    for (std::size_t i = 0; i < std::min<std::size_t>(2, options.size()); ++i) {
      if (of_rest + options[i].score < now - 20.0) break;
      const auto option = refined(options[i], others, of_others);
      if (option.atom == set[k] || of_rest + option.score <= now + better) continue;
      set[k] = option.atom;
      return true;
    }
  }
  return false;
}

// Two terms for one other: a force constant is mass, Coulomb and viscous friction together.
bool Search::merge(ActiveSet& set) {
  const double now = score(set);
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::size_t j = i + 1; j < set.size(); ++j) {
      const auto others = without(without(set, j), i);
      const auto of_others = posterior(others);
      double of_rest = of_others.nats();
      for (const auto* atom : others) of_rest += atom->log_prior;
      const auto options = options_beside(others, of_others);
      if (options.empty() || of_rest + options.front().score < now - 20.0) continue;
      const auto one = refined(options.front(), others, of_others);
      if (of_rest + one.score <= now + better) continue;
      set = others;
      set.push_back(one.atom);
      return true;
    }
  return false;
}

// Names for a term that has none: what each of them explains less well, some may explain better together, as harmonics
// of a wave do. What the term has hidden is looked for first.
bool Search::name_instead(ActiveSet& set, const ActiveSet& known) {
  auto kept = known;
  kept.insert(kept.end(), set.begin(), set.end());
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (!candidates()[set[k]->candidate].outside()) continue;
    const double now = score(set);
    auto named = without(set, k);
    bool scanned = false;
    for (std::size_t names = 0; names < most_instead; ++names) {
      if (!scanned) scan_lines(named, kept);
      const auto of_named = posterior(named);
      auto options = options_beside(named, of_named);
      std::erase_if(options, [](const Option& option) { return candidates()[option.atom->candidate].outside(); });
      // As much as the first of them explains the others hardly do.
      const auto left = static_cast<double>(most_instead - names);
      if (options.empty() || score(named) + left * options.front().score <= now + better) break;
      scanned = !candidates()[options.front().atom->candidate].periodic;
      named.push_back(refined(options.front(), named, of_named).atom);
      kept.push_back(named.back());
      if (score(named) <= now + better) continue;
      set = std::move(named);
      return true;
    }
  }
  return false;
}

void Search::improve(ActiveSet& set) {
  for (std::size_t round = 0; round < most_rounds; ++round)
    if (!move_one(set) && !merge(set)) return;
}

// How likely the term is its candidate, and which others it may be. Differences of evidence are as good as the
// description of what is there: they count less where more of it has to be described.
void Search::name(const ActiveSet& set, std::size_t term, Term& as) {
  const auto others = without(set, term);
  const auto of_others = posterior(others);
  auto options = options_beside(others, of_others);
  for (std::size_t k = 0; k < std::min(refined_each, options.size()); ++k)
    options[k] = refined(options[k], others, of_others);
  const double own = score(set) - score(others);
  const double blur = std::max(1.0, of_strongest * own / std::log(telling));
  double sum = 1.0 + std::exp(-std::min(own, worth(set, term).by_own_spectrum) / blur);
  for (const auto& option : options)
    if (!one_cause(option.atom->candidate, set[term]->candidate)) sum += std::exp((option.score - own) / blur);
  as.nats = own;
  as.probability = 1.0 / sum;
  for (const auto& option : options) {
    const double probability = std::exp((option.score - own) / blur) / sum;
    const auto c = option.atom->candidate;
    if (!one_cause(c, set[term]->candidate) && probability > least_probability)
      as.alternatives.push_back({c, probability});
  }
}

// Share of the residual's square that a term explains, given the others of the set.
double Search::explained_by(const ActiveSet& set, std::size_t term) const {
  return (plain_.fit(columns_of(without(set, term))).left - plain_.fit(columns_of(set)).left) / plain_.total();
}

void Search::discard(std::size_t candidate, std::string why, bool nearly) {
  if (!candidates()[candidate].outside()) discarded_.push_back({candidate, std::move(why), nearly});
}

std::vector<Term> Search::terms_of(const ActiveSet& set) {
  std::vector<Term> terms;
  for (std::size_t k = 0; k < set.size(); ++k) {
    Term term;
    term.candidate = set[k]->candidate;
    term.shape = set[k]->shape;
    const auto others = columns_of(without(set, k));
    term.judgement = judge_columns(evidence_, plain_, others, set[k]->group.columns,
                                   trials_of(scene_, set[k]->candidate, set[k]->shape));
    term.explains = explained_by(set, k);
    if (candidates()[term.candidate].outside()) term.size = posterior(without(set, k)).gain_of(set[k]->group).size;
    name(set, k, term);
    terms.push_back(std::move(term));
  }
  return terms;
}

// From noise that is what is left now, or what is left when all candidates have taken what they can. What is `known`
// stays an option.
Dictionary::ActiveSet Search::searched_from(bool absorbed, const ActiveSet& known) {
  ActiveSet set;
  whiten(set, absorbed);
  scan_lines(set, known);
  for (std::size_t round = 0; round < most_rounds && set.size() < most_terms && grow(set); ++round) {
    improve(set);
    whiten(set, false);
    scan_lines(set, known);
  }
  for (std::size_t round = 0; round < most_rounds && name_instead(set, known); ++round) {
    improve(set);
    whiten(set, false);
  }
  scan_lines(set, known);
  // What stays is judged by the noise that it leaves.
  improve(set);
  whiten(set, false);
  return set;
}

// Drops what is not worth its price and what it has to be worth beyond that.
void Search::prune(ActiveSet& set) {
  for (;;) {
    const auto left = leftover(set);
    std::size_t weakest = set.size();
    double lowest = 0.0, found = 0.0, expected = 0.0;
    for (std::size_t k = 0; k < set.size(); ++k) {
      const auto own = worth(set, k);
      const double beyond = std::min(own.by_one_noise - left.by_one_noise, own.by_own_spectrum - left.by_own_spectrum);
      const double least = sure + (scene_.hurdles.empty() ? 0.0 : scene_.hurdles[set[k]->candidate]);
      if (beyond - least < lowest) lowest = beyond - least, weakest = k, found = beyond, expected = least;
    }
    if (weakest == set.size()) return;
    discard(set[weakest]->candidate,
            fmt::format("log odds against its absence, above the remainder of stronger findings: {:.1f}; expected at "
                        "least {:.1f}",
                        found, expected),
            true);
    set = without(set, weakest);
    whiten(set, false);
    improve(set);
  }
}

// Without a name that the exact machine's records have too another may come out, which is looked at in turn. A name
// that is worth more than what those say for it is there or something like it is: beside others it pays what they say
// in the median, and has to be worth the rest where it is called a cause. Else it pays all, so that others may take its
// place. Where the regressors move, or read, as the disturbed axis does a name can be what a disturbance does to them,
// so that all of the target is taken for one: the rest beside that name has lost just this part, and beyond the price
// nothing is to pay.
SearchResult Search::run_calibrated() {
  auto result = run();
  const auto moves_as_disturbed = [&](std::size_t name) {
    return scene_.disturbed_motion || candidates()[name].of_reading;
  };
  std::optional<Calibration> calibration;
  std::set<std::size_t> known;
  while (scene_.exact_records) {
    // What has no name is priced as well: it would take the place of a name that has a price, unless it had one too.
    std::vector<std::size_t> names;
    for (const auto* atom : found_)
      if (known.insert(atom->candidate).second) names.push_back(atom->candidate);
    if (names.empty()) break;
    if (!calibration) {
      const bool moves = std::any_of(names.begin(), names.end(), moves_as_disturbed);
      const auto& noise = moves ? evidence_.target() : result.residual;
      calibration.emplace(scene_, noise.cwiseProduct(counts_));
    }
    const auto odds_in = [&](const ExactRecord& record) { return names_in(record, names, Weights::all); };
    const auto own = names_in({evidence_.target(), {}}, names, Weights::possible);
    scene_.prices.resize(candidates().size(), 0.0);
    scene_.hurdles.resize(candidates().size(), 0.0);
    bool changed = false;
    // On which side of its limit what has no name is decides no name.
    std::vector<std::optional<double>> to_tell(own.begin(), own.end());
    for (std::size_t k = 0; k < names.size(); ++k)
      if (candidates()[names[k]].outside()) to_tell[k].reset();
    const auto prices = calibration->prices(odds_in, to_tell);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto [typical, limit] = prices[k];
      const bool beyond = own[k] - limit > sure;
      const bool moves = moves_as_disturbed(names[k]);
      scene_.prices[names[k]] = !beyond ? limit : moves ? 0.0 : typical;
      scene_.hurdles[names[k]] = beyond && !moves ? limit - typical : 0.0;
      changed = changed || scene_.prices[names[k]] > 0.0 || scene_.hurdles[names[k]] > 0.0;
    }
    if (!changed) break;
    begin_again(found_);
    result = run();
  }
  if (calibration) result.exact_records = calibration->records();
  for (const auto c : known)
    if (!scene_.prices.empty() && scene_.prices[c] + scene_.hurdles[c] > 0.0 &&
        std::none_of(result.terms.begin(), result.terms.end(), [&](const Term& term) { return term.candidate == c; }))
      result.discarded.push_back(
          {c, fmt::format("records of the machine as its file says, under forces like the residual, show it too: of {} "
                          "that were simulated one in a hundred has log odds above {:.1f}",
                          result.exact_records, scene_.prices[c] + scene_.hurdles[c] + sure)});
  return result;
}

void Search::search_without_each_log(SearchResult& result) {
  const std::size_t parts = std::min(rows_.logs().size(), most_parts);
  const auto named = [](const Term& term) { return !candidates()[term.candidate].outside(); };
  if (parts < 2 || std::none_of(result.terms.begin(), result.terms.end(), named)) return;
  for (auto& term : result.terms)
    if (named(term)) term.without_each_log = NamedIn{0, parts};
  for (std::size_t part = 0; part < parts; ++part) {
    leave_out(found_, part, parts);
    ActiveSet set;
    for (std::size_t round = 0; round < most_rounds && set.size() < most_terms && grow(set); ++round) improve(set);
    prune(set);
    for (auto& term : result.terms)
      if (term.without_each_log)
        term.without_each_log->named += std::any_of(
            set.begin(), set.end(), [&](const auto* atom) { return one_cause(atom->candidate, term.candidate); });
  }
  take_all();
}

SearchResult Search::run() {
  discarded_.clear();
  refused_.clear();
  auto known = found_;
  auto set = searched_from(true, known);
  known.insert(known.end(), set.begin(), set.end());
  const double of_first = with_own_noise(set);
  const auto other = searched_from(false, known);
  const double of_other = with_own_noise(other);
  if (of_other > of_first) set = other;
  whiten(set, false);
  SearchResult result;
  // Terms that nearly cancel each other can end with values that they cannot have: without such a one what it has kept
  // out may enter.
  for (;;) {
    prune(set);
    result.terms = terms_of(set);
    result.residual = refine(rows_, evidence_, scene_, result.terms);
    std::size_t k = 0;
    std::optional<std::string> why;
    while (k < set.size() && !(why = impossible(scene_, result.terms[k]))) ++k;
    if (k == set.size()) break;
    refused_.insert(set[k]->candidate);
    discard(set[k]->candidate, *why, false);
    set = without(set, k);
    improve(set);
    for (std::size_t round = 0; round < most_rounds && set.size() < most_terms && grow(set); ++round) improve(set);
  }
  found_ = set;
  for (const auto& d : discarded_)
    if (std::none_of(result.terms.begin(), result.terms.end(),
                     [&](const Term& term) { return term.candidate == d.candidate; }) &&
        std::none_of(result.discarded.begin(), result.discarded.end(),
                     [&](const Discarded& known) { return known.candidate == d.candidate; }))
      result.discarded.push_back(d);
  std::sort(result.terms.begin(), result.terms.end(),
            [](const Term& a, const Term& b) { return a.explains > b.explains; });
  result.correlation = correlation_;
  result.blocks = evidence_.blocks();
  return result;
}

}  // namespace

SearchResult search_causes(const LogRows& rows, const Eigen::VectorXd& target, SearchContext& context) {
  Search search(rows, target, context);
  auto result = search.run_calibrated();
  search.search_without_each_log(result);
  return result;
}

}  // namespace stiction::host
