// What is wrong with the bytes of a cam table (cam_table.hpp).
#pragma once

#include <cstdint>

namespace stiction {

enum class CamTableProblem : std::uint8_t {
  none,
  too_short,      // no whole header and checksum
  no_table,       // it does not begin as a cam table
  version,        // of a different version of the format
  size,           // more or fewer bytes than the counts of segments, tracks and windows make
  checksum,       // a byte was changed
  kind,           // a master or slave that is neither linear nor rotary, or unknown flags
  scale,          // scales beyond what evaluation can shift by
  segment_order,  // segments that do not begin at 0 and rise
  track_windows   // tracks that do not share the windows among them, each at least one
};

}  // namespace stiction
