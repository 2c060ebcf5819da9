// FNV-1a, 64 bits, over raw words of signals.
#pragma once

#include <cstdint>

namespace stiction::targets {

class Hash {
 public:
  constexpr void add(std::int64_t word) {
    for (int shift = 0; shift < 64; shift += 8)
      value_ = (value_ ^ ((static_cast<std::uint64_t>(word) >> shift) & 0xFF)) * 0x100000001b3u;
  }
  constexpr std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace stiction::targets
