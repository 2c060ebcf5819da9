// Cyclic redundancy checks of frames and files, a table of 256 entries each, computed when compiled.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace stiction {

// The most significant bit first, not reflected, nothing added at the end.
template <std::unsigned_integral Word, Word polynomial, Word initial>
class Crc {
 public:
  constexpr Crc& add(std::uint8_t byte) {
    // A word of one byte has nothing left behind the byte that goes out.
    const auto index = static_cast<std::uint8_t>((value_ >> (bits - 8)) ^ byte);
    value_ = static_cast<Word>((std::uint32_t{value_} << 8) ^ table[index]);
    return *this;
  }
  template <class Bytes>
  constexpr Crc& add(const Bytes& data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) add(static_cast<std::uint8_t>(data[i]));
    return *this;
  }
  constexpr Word value() const { return value_; }

 private:
  static constexpr int bits = 8 * sizeof(Word);
  static constexpr std::array<Word, 256> table = [] {
    std::array<Word, 256> words{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      std::uint32_t word = byte << (bits - 8);
      for (int bit = 0; bit < 8; ++bit) word = (word << 1) ^ ((word >> (bits - 1) & 1u) != 0u ? polynomial : 0u);
      words[byte] = static_cast<Word>(word);
    }
    return words;
  }();

  Word value_ = initial;
};

// CRC-8 of SAE J1850 without its final inversion: two flipped bits in up to 15 bytes are always seen.
using Crc8 = Crc<std::uint8_t, 0x1D, 0xFF>;
// CRC-16/IBM-3740 (CCITT polynomial): three flipped bits in up to 4 kB are always seen.
using Crc16 = Crc<std::uint16_t, 0x1021, 0xFFFF>;

}  // namespace stiction
