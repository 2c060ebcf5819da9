// An experiment's figures as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// A figure's name and its unit as one key: "peak_deviation_lugre_um", "speed_m_per_min", "gain_N_s_per_m"; the name
// alone for a plain number.
std::string figure_key(const sim::Figure& figure);

// "stiction.EXPERIMENT/1": "results" by key, "expected" and "holds" for those of which a source says something, and
// "findings". Throws std::invalid_argument when two figures have the same key.
nlohmann::ordered_json experiment_json(const sim::ExperimentResult& result, const machine::Machine& machine);

// The same as text for a terminal, with the question, the findings and a verdict.
std::string experiment_text(const sim::ExperimentResult& result, const machine::Machine& machine);

}  // namespace stiction::host
