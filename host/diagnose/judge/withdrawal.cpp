#include "host/diagnose/judge/withdrawal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/diagnose/judge/finding_evidence.hpp"
#include "host/diagnose/statistics/most_odds.hpp"

namespace stiction::host {
namespace {

constexpr double of_training = 0.1;  // residuals hold more than noise: a p-value claims too much

// Up to where held-out records may speak against a term (HeldOutAmplitude::against) that stays: not at all, where they
// would know it; else a small part of what the training records say for it, by the most that its p-value can mean as a
// Bayes factor among so many candidates: records on which it hardly acts
// speak by chance.
double most_against(const Term& term, const HeldOutAmplitude& held_out_amplitude) {
  if (!held_out_amplitude.may_be_all()) return 0.0;
  const double odds = most_odds(term.judgement.p_value) / static_cast<double>(candidates().size());
  return std::max(2.0 * of_training * std::log(odds), 0.0);
}

std::vector<Term> with_maps(std::vector<Term> terms, std::span<const Term> maps) {
  terms.insert(terms.end(), maps.begin(), maps.end());
  return terms;
}

HeldOutFigures figures_of(const HeldOutData& data, const std::vector<Term>& terms, std::span<const Term> maps) {
  return evaluate_held_out(data, with_maps(terms, maps));
}

}  // namespace

std::vector<Withdrawn> keep_what_holds(const HeldOutData& data, std::vector<Term>& terms, std::span<const Term> maps) {
  std::vector<Withdrawn> withdrawn;
  while (!terms.empty()) {
    const auto figures = figures_of(data, terms, maps);
    std::vector<double> too_much;
    for (std::size_t k = 0; k < terms.size(); ++k)
      too_much.push_back(figures.held_out_amplitudes[k].against() -
                         most_against(terms[k], figures.held_out_amplitudes[k]));
    const auto worst =
        static_cast<std::size_t>(std::distance(too_much.begin(), std::max_element(too_much.begin(), too_much.end())));
    // Each may gain beside the others and all of them together lose: wrong names that lean on each other.
    const bool holds_alone = too_much[worst] < 0.0;
    if (holds_alone && (terms.size() == 1 || figures.together.against() < 0.0)) return withdrawn;
    withdrawn.push_back(
        {terms[worst].candidate,
         fmt::format(
             "withdrawn: found in the training data, but without improvement on held-out data: held-out amplitude {} "
             "of the fitted one{}, residual force {:.4f} times that without it",
             repeated(holds_alone ? figures.together : figures.held_out_amplitudes[worst]),
             holds_alone ? ", together with all other findings" : "",
             holds_alone ? figures.force_extended / figures.force_baseline : figures.gains[worst].force_rms_ratio)});
    terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  return withdrawn;
}

HeldOutFigures keep_confirmed_maps(const HeldOutData& data, const std::vector<Term>& terms, std::vector<Term>& maps) {
  auto figures = figures_of(data, terms, maps);
  for (std::size_t k = 0; k < maps.size();) {
    if (figures.held_out_amplitudes[terms.size() + k].against() < 0.0) {
      ++k;
      continue;
    }
    maps.erase(maps.begin() + static_cast<std::ptrdiff_t>(k));
    figures = figures_of(data, terms, maps);
    k = 0;
  }
  return figures;
}

}  // namespace stiction::host
