// Questions about a log as the commands write them with --json.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "host/log/questions.hpp"

namespace stiction::host {

// An array: of each question its kind, text, value with 95 % interval, and probability. `questions`: in their order.
nlohmann::ordered_json questions_json(const std::vector<Question>& questions);

}  // namespace stiction::host
