// The stretches of a record that has gaps.
#pragma once

#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

// All stretches of the record that `log`, as a reader returned it, is the longest of, in the record's order.
std::vector<Log> stretches_of(Log log);

}  // namespace stiction::host
