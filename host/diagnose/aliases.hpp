// What a finding may be confused with, whatever the data, and the experiment that separates the two (the method's alias
// table).
#pragma once

#include <string_view>
#include <vector>

#include "host/diagnose/verdict.hpp"

namespace stiction::host {

// `exact`: no motion of this axis alone separates them.
struct Alias {
  std::string_view effect, other, separate_by;
  bool exact = false;
};

std::vector<Alias> aliases_of(std::string_view effect);

}  // namespace stiction::host
