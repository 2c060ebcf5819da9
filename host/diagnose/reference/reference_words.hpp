// What is said of causes that were found, or could not be told, from measured rows. Sentences only; the numbers come
// from reference_extension.hpp and the simulated rows.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/reference/reference_extension.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

sim::EffectId effect_of(SlidingPart part);

// `extension` of the machine, its part for this `axis`, the `effect` that is named, and the row that trained it
// (`training_row`).
std::string evidence_words(const ReferenceExtension& extension, const AxisExtension& axis, sim::EffectId effect,
                           const machine::CircleReference& training_row);

// `extension` of the machine, its part for this `axis`, the `effect` that is named.
std::vector<ConfusedWith> confusion_words(const ReferenceExtension& extension, const AxisExtension& axis,
                                          sim::EffectId effect);

// Every effect of the vocabulary that is not named, and why.
std::vector<Rejected> rejection_words(const machine::Machine& machine, const Verdict& verdict);

// What the extended simulation leaves of the rows that took no part, as share of the squared relative deviations of
// their currents.
Unexplained left_words(const std::vector<DiagnosedRow>& rows);

std::vector<std::string> note_words(const ReferenceExtension& extension);

}  // namespace stiction::host
