// "stiction.verdict/1" (docs/schemas/verdict-1.json), and the same for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/diagnose/verdict.hpp"

namespace stiction::host {

// Beside verdict.json: the set-points of what to record next.
inline constexpr const char* next_measurement_file = "next_measurement.csv";

nlohmann::ordered_json verdict_json(const Verdict& verdict);
std::string verdict_text(const Verdict& verdict);
// One line: what to record next and what is expected of it.
std::string next_measurement_text(const NextMeasurement& next);

}  // namespace stiction::host
