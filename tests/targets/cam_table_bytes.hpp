// A cam table of 256 segments, made while compiling: the polynomial 3-4-5 up over half of the cycle and down over the
// other one, each of its parts exactly a polynomial of fifth degree.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/motion/cam_table.hpp"

namespace stiction::targets {

inline constexpr std::size_t cam_segments = 256;
inline constexpr std::size_t cam_bytes_size =
    CamTable::header_size + cam_segments * CamTable::segment_size + CamTable::checksum_size;

class CamBytes {
 public:
  constexpr CamBytes() {
    for (const char c : {'S', 'C', 'A', 'M'}) put(static_cast<std::uint64_t>(c), 1);
    put(CamTable::version, 2);
    put(1, 1), put(1, 1), put(1, 1);
    put(46, 1), put(46, 1), put(40, 1);  // bits of position, speed, acceleration
    put(cam_segments, 4);
    put(std::uint64_t{6908579894468}, 8);   // 2 pi
    for (int k = 0; k < 4; ++k) put(0, 8);  // rise and bounds
    put(0, 8);                              // no tracks
    for (std::uint32_t k = 0; k < cam_segments; ++k) segment(k);
    put(Crc32{}.add(bytes, CamTable::header_size + cam_segments * CamTable::segment_size).value(), 4);
  }
  std::array<std::uint8_t, cam_bytes_size> bytes{};

 private:
  constexpr void put(std::uint64_t value, int size) {
    for (int k = 0; k < size; ++k) bytes[at_++] = static_cast<std::uint8_t>(value >> (8 * k));
  }
  // Whole numbers in 128 parts of the rise: f = (10 k^3 128^2 - 15 k^4 128 + 6 k^5) / 128^5, by Taylor's series at k.
  constexpr void segment(std::uint32_t number) {
    const bool down = number >= cam_segments / 2;
    const auto k = static_cast<std::int64_t>(number % (cam_segments / 2));
    const std::int64_t n = 128;
    const std::int64_t c[6] = {10 * k * k * k * n * n - 15 * k * k * k * k * n + 6 * k * k * k * k * k,
                               30 * k * k * n * n - 60 * k * k * k * n + 30 * k * k * k * k,
                               30 * k * n * n - 90 * k * k * n + 60 * k * k * k,
                               10 * n * n - 60 * k * n + 60 * k * k,
                               -15 * n + 30 * k,
                               6};
    constexpr int scale = 46 - 35, coarse = 24 - shift;  // 128^5 = 2^35
    put(std::uint64_t{number} << 24, 4);
    put(std::uint64_t{1} << 31, 4);
    const std::int64_t begin = c[0] * (1 << scale);
    put(static_cast<std::uint64_t>(down ? (std::int64_t{1} << 46) - begin : begin), 8);
    std::uint64_t finer = 0;
    for (int i = 1; i < 6; ++i) {
      const std::int64_t value = c[i] * (1 << scale) / (1 << coarse) * (1 << finer_bits[i]);
      put(static_cast<std::uint64_t>(down ? -value : value), 4);
      if (i > 1) finer |= static_cast<std::uint64_t>(finer_bits[i]) << (4 * (i - 2));
    }
    put(23, 1), put(shift, 1), put(finer, 2);
  }

  static constexpr int shift = 15;
  // As far as the largest of each stays within a word.
  static constexpr int finer_bits[6] = {0, 0, 6, 11, 15, 15};
  std::size_t at_ = 0;
};

inline constexpr CamBytes cam_bytes;

}  // namespace stiction::targets
