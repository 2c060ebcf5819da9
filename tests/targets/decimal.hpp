// Prints a whole number without a C library.
#pragma once

#include <array>
#include <cstdint>

#include "tests/targets/platform/platform.hpp"

namespace stiction::targets {

inline void print_decimal(std::uint32_t number) {
  std::array<char, 11> text{};
  std::size_t at = text.size() - 1;
  do {
    text[--at] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number > 0);
  print(&text[at]);
}

}  // namespace stiction::targets
