// Any bytes as a drive's cam table, as they are and with a checksum that fits: what is accepted is evaluated at the
// borders of its segments and between them, and no shift, sum or product is undefined.
#include <cstdint>
#include <vector>

#include "stiction/motion/cam_table.hpp"

namespace stiction::fuzz {
namespace {

std::int64_t sink = 0;

void evaluate(const CamTable& table) {
  for (std::uint32_t k = 0; k < table.header().count && k < 200; ++k) {
    const std::uint32_t start = table.segment(k).start;
    for (const std::uint32_t phase : {start, start + 1, start - 1, start * 2654435769u}) {
      const auto out = table.evaluate(phase);
      sink ^= out.position ^ out.speed ^ out.acceleration;
    }
  }
  sink ^= table.evaluate(UINT32_MAX).position;
  for (std::uint32_t k = 0; k < table.header().tracks && k < 20; ++k)
    sink ^= table.is_on(k, k * 2654435769u, INT32_MIN, true) + table.is_on(k, k, INT32_MAX, false);
}

void write(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = static_cast<std::uint8_t>(value >> (8 * k));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CamTable table;
  if (CamTable::read({data, size}, table) == CamTableProblem::none) evaluate(table);
  // The same with mark, version, count and checksum as they must be, so that what is behind them is reached.
  std::vector<std::uint8_t> bytes(data, data + size);
  const std::size_t count =
      bytes.size() > CamTable::header_size ? (bytes.size() - CamTable::header_size) / CamTable::segment_size : 0;
  if (count == 0) return 0;
  bytes.resize(CamTable::header_size + count * CamTable::segment_size);
  bytes[0] = 'S', bytes[1] = 'C', bytes[2] = 'A', bytes[3] = 'M';
  bytes[4] = CamTable::version, bytes[5] = 0;
  for (const std::size_t kind : {6, 7, 8}) bytes[kind] &= 1;
  write(bytes, 12, static_cast<std::uint32_t>(count));
  // Up to three tracks of a window each, of the last segment's bytes.
  const std::uint32_t tracks = bytes[56] % 4u;
  write(bytes, 56, tracks | tracks << 16);
  bytes.resize(bytes.size() + tracks * (CamTable::track_size + CamTable::window_size), bytes.back());
  const std::size_t behind = CamTable::header_size + count * CamTable::segment_size;
  for (std::uint32_t k = 0; k < tracks; ++k) write(bytes, behind + CamTable::track_size * k, k | 1u << 16);
  write(bytes, CamTable::header_size, 0);
  const auto checksum = Crc32{}.add(bytes, bytes.size()).value();
  bytes.resize(bytes.size() + CamTable::checksum_size);
  write(bytes, bytes.size() - CamTable::checksum_size, checksum);
  if (CamTable::read(bytes, table) == CamTableProblem::none) evaluate(table);
  return 0;
}

}  // namespace stiction::fuzz
