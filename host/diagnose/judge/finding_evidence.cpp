#include "host/diagnose/judge/finding_evidence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sim/effects/effects.hpp"
#include "sim/effects/force_map/force_map.hpp"

namespace stiction::host {
namespace {

// The pair that no motion of this axis alone separates; else of the alias table and beside it what the data show.
std::vector<ConfusedWith> confused_with(const Term& term) {
  std::vector<ConfusedWith> list;
  const auto known = sim::confusions_of(*candidates()[term.candidate].effect);
  for (const auto& confusion : known)
    if (confusion.always) list.push_back({confusion.other, std::string(confusion.separate_by), true});
  for (const auto& [candidate, probability] : term.alternatives) {
    if (candidates()[candidate].outside()) continue;
    const sim::EffectId other = *candidates()[candidate].effect;
    if (std::any_of(list.begin(), list.end(), [&](const ConfusedWith& l) { return l.effect == other; })) continue;
    const auto alias = std::find_if(known.begin(), known.end(), [&](const auto& a) { return a.other == other; });
    list.push_back({other,
                    alias != known.end() ? std::string(alias->separate_by)
                                         : "record longer, with different speeds, accelerations and strokes: in "
                                           "these records both explain the residual equally well",
                    false, probability});
  }
  return list;
}

std::string evidence_of(const Term& term, const HeldOutAmplitude& held_out_amplitude, std::size_t blocks) {
  const auto& j = term.judgement;
  return fmt::format(
      "Explains {:.1f} % of the residual variance given the other findings ({:.1f} % cross-validated), p = {:.2g} from "
      "{} blocks of rows. Amplitude in the first half of the blocks: {:.2f} of the fitted one, in the second half: "
      "{:.2f}. Held-out amplitude: {} of the fitted one{}.",
      100.0 * term.explains, 100.0 * j.gain, j.p_value, blocks, j.first_half, j.second_half,
      repeated(held_out_amplitude),
      held_out_amplitude.against() < 0.0 ? "" : ", which neither confirms nor refutes it");
}

}  // namespace

std::string repeated(const HeldOutAmplitude& held_out_amplitude) {
  return fmt::format("{:.2f} +- {:.2f}", held_out_amplitude.size, held_out_amplitude.deviation);
}

void give_evidence(Finding& finding, const Term& term, const HoldoutGain& gain,
                   const HeldOutAmplitude& held_out_amplitude, std::size_t blocks) {
  finding.explains = term.explains;
  finding.holdout = gain;
  finding.p_value = term.judgement.p_value;
  finding.probability = term.probability;
  finding.without_each_log = term.without_each_log;
  finding.confused_with = confused_with(term);
  finding.evidence = evidence_of(term, held_out_amplitude, blocks);
}

Finding map_finding(const SearchContext& context, const Term& term, const HoldoutGain& gain,
                    const HeldOutAmplitude& held_out_amplitude) {
  const auto& candidate = candidates()[term.candidate];
  Finding finding(sim::id_of<sim::ForceMap>());
  finding.axis = context.axis.name;
  candidate.describe(context, term.shape, term.coefficients, term.covariance, finding);
  finding.explains = term.explains;
  finding.holdout = gain;
  finding.p_value = term.judgement.p_value;
  finding.probability = term.probability;
  finding.evidence =
      fmt::format("{}. Held-out amplitude: {} of the fitted one.",
                  candidate.looks_like(context, term.shape, term.coefficients), repeated(held_out_amplitude));
  return finding;
}

Unexplained unexplained_by(const SearchContext& context, const std::vector<Term>& unnamed) {
  Unexplained unexplained;
  std::vector<std::string> words;
  for (const auto& term : unnamed) {
    unexplained.share += term.explains;
    words.push_back(candidates()[term.candidate].looks_like(context, term.shape, term.coefficients));
  }
  if (!words.empty()) unexplained.signature = fmt::format("{}", fmt::join(words, "; and "));
  return unexplained;
}

}  // namespace stiction::host
