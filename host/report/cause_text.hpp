// What a report says to readers about each cause that a diagnosis may name. A new effect is one row of the table; one
// without a row is shown under its own name.
#pragma once

#include <string>

namespace stiction::host {

struct CauseText {
  std::string title;    // "Force ripple (cogging)"
  std::string meaning;  // what it is
  std::string advice;   // what to do about it
};

CauseText cause_text(const std::string& effect);

}  // namespace stiction::host
