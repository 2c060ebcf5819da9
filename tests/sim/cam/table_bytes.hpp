// The drive's tables of 100 motion files that are drawn at random, as checksums: equal on every host, compiler and
// processor, or a table does not say which motion it is.
#pragma once

#include "sim/cam/motion_file.hpp"
#include "sim/cam/segment_table.hpp"
#include "tests/sim/cam/random_motion_file.hpp"

namespace stiction::sim::cam {

inline constexpr std::uint64_t drawn_files = 100;

// The CRC-32 of the table of the file that `seed` draws, read from its text.
inline std::uint32_t table_checksum(std::uint64_t seed) {
  const auto cams = parse_motion_file("drawn.toml", RandomMotionFile(seed).text());
  const auto table = table_within(compose(cams.front()), 1e-8);
  return Crc32{}.add(table.bytes, table.bytes.size()).value();
}

}  // namespace stiction::sim::cam
