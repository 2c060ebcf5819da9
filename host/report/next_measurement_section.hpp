// The section "What to record next" of a diagnosis' page.
#pragma once

#include <nlohmann/json.hpp>

#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// For drawNext() of diagnosis.js; null where nothing is open. `axis`: in the names of its files, empty: the only one.
nlohmann::ordered_json next_measurement_json(const std::optional<NextMeasurement>& next, const std::string& axis);

}  // namespace stiction::host
