// Between which positions a table's curve is in a cycle.
#pragma once

#include <algorithm>
#include <cstdint>

#include "stiction/drive/cam_mode.hpp"

namespace stiction::drive {

// By its value at 16 places of each segment of `table`, which is within a thousandth of the rise between two of them.
// `made`: whose curve is that of the table; its ends are set.
inline void find_range(const CamTable& table, CamMode::Table& made) {
  made.low = INT64_MAX;
  made.high = INT64_MIN;
  const std::uint32_t count = table.header().count;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint64_t begin = table.segment(k).start;
    const std::uint64_t end = k + 1 < count ? table.segment(k + 1).start : std::uint64_t{1} << 32;
    for (std::uint64_t part = 0; part < 16; ++part) {
      const std::uint64_t phase = (begin + (end - begin) * part / 16) << 32;
      const std::int64_t position = made.curve.slopes({0, phase}).position;
      made.low = std::min(made.low, position);
      made.high = std::max(made.high, position);
    }
  }
}

}  // namespace stiction::drive
