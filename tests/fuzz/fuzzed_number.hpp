// A number as text, from a fuzzer's bytes.
#pragma once

#include <fmt/format.h>
#include <fuzzer/FuzzedDataProvider.h>

#include <string>

namespace stiction::fuzz {

// Whole numbers, because only they fit a count; magnitudes that a careless engineer might write; and the rest.
inline std::string fuzzed_number(FuzzedDataProvider& bytes) {
  const int kind = bytes.ConsumeIntegralInRange<int>(0, 3);
  if (kind == 0) return fmt::format("{}", bytes.ConsumeIntegralInRange<int>(-1, 100));
  const int reach = kind == 3 ? 323 : 13;
  return fmt::format("{}e{}", bytes.ConsumeFloatingPointInRange(0.5, 2.0),
                     bytes.ConsumeIntegralInRange<int>(-reach, reach));
}

}  // namespace stiction::fuzz
