// A commented machine file from the answers to sheet_questions(): the file holds amplitude amperes and one winding,
// whatever the sheet gives; controllers are set by rules from what they control; what is estimated is marked, and so is
// what logs tell (log_facts.hpp).
#pragma once

#include <string>

#include "host/sheet/log_marks.hpp"
#include "host/sheet/questions.hpp"

namespace stiction::host {

// `answers`: complete and without objections; `command`: with which the file was made, for its head; `marks`: what logs
// say of the answers and beside them.
std::string machine_text(const SheetAnswers& answers, const std::string& command, const LogMarks& marks = {});

}  // namespace stiction::host
