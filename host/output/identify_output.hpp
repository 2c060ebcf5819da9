// An identification as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/identify/identification.hpp"

namespace stiction::host {

// "stiction.identification/1".
nlohmann::ordered_json identification_json(const Identification& result);

// The same for a terminal.
std::string identification_text(const Identification& result);

}  // namespace stiction::host
