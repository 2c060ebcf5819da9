// A commented machine file from the answers to sheet_questions(): the file holds amplitude amperes and one winding,
// whatever the sheet gives; controllers are set by rules from what they control; what is estimated is marked.
#pragma once

#include <string>

#include "host/sheet/questions.hpp"

namespace stiction::host {

// `answers`: complete and without objections; `command`: with which the file was made, for its head.
std::string machine_text(const SheetAnswers& answers, const std::string& command);

}  // namespace stiction::host
