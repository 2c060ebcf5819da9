// The result of `stiction cam step` as text and as a page.
#pragma once

#include <string>

#include "host/cam/step/result.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

// The page of `result`. `command`: the command line, `version` of stiction, `origin`: the source files.
std::string step_page(const step::StepResult& result, const std::string& command, const std::string& version,
                      const Origin& origin);

// `result` as text.
std::string step_text(const step::StepResult& result);

}  // namespace stiction::host
