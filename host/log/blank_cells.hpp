// Blank cells of a table (NaN) before its clock is judged.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

// Leaves no NaN in `log`. A channel without any value is absent. The record is trimmed to where every axis has its
// position (or, without one, its speed) and its effort; rows without them are dropped where they are more than a fifth
// (the table is written faster than they are sampled), else they are interpolated and left out of every fit. Blank
// cells of other channels are interpolated, at the ends held; one of which more than half is blank by the time it
// covers is absent. `log`: t as written; a note says what was done. `place`: the name of row k, for messages. Returns
// the rows that are kept; empty: all. Throws LogError where nothing is left.
std::vector<std::size_t> treat_blank_cells(Log& log, const std::function<std::string(std::size_t)>& place);

}  // namespace stiction::host
