// "stiction.verdict/1", and the same for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/diagnose/verdict.hpp"

namespace stiction::host {

nlohmann::ordered_json verdict_json(const Verdict& verdict);
std::string verdict_text(const Verdict& verdict);

}  // namespace stiction::host
