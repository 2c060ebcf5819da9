// Numbers for the page.
#pragma once

#include <cstddef>
#include <vector>

namespace stiction::host {

// Rows of numbers, one behind the other.
struct StudioTable {
  std::size_t columns = 0;
  std::vector<double> values;
};

}  // namespace stiction::host
