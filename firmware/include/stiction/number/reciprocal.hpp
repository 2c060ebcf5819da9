// Reciprocal of a time interval without a 64-bit division: fixed work on targets that have none.
#pragma once

#include <bit>
#include <cstdint>

#include "stiction/number/fixed.hpp"

namespace stiction {

// Sampling rate in 1/s of an interval between samples.
using Rate = Coefficient<10>;

// 1 / interval for 1000 ns to 2^31 - 1 ns, relative error below 2^-28 plus the rounding to the format; shorter
// intervals give the rate of 1000 ns. A 16-bit seed from one 32-bit division, doubled in precision by Newton's step.
constexpr Rate rate_of_interval(std::int64_t interval_ns) {
  const auto bounded = static_cast<std::uint32_t>(interval_ns < 1000        ? 1000
                                                  : interval_ns > INT32_MAX ? INT32_MAX
                                                                            : interval_ns);
  const int shift = std::countl_zero(bounded);             // 1 .. 22
  const std::uint32_t normal = bounded << shift;           // d * 2^32, d in [1/2, 1)
  const std::uint32_t seed = UINT32_MAX / (normal >> 16);  // r = 1/d * 2^16, within 2^-15 of itself
  // r + r (1 - d r): the residual 1 - d r, below 2^-14, is kept with 44 fraction bits in one word.
  const auto residual = static_cast<std::int32_t>(
      static_cast<std::int64_t>((std::uint64_t{1} << 48) - std::uint64_t{normal} * seed) >> 4);
  const auto correction = static_cast<std::int32_t>(
      (static_cast<std::int64_t>(residual) * static_cast<std::int32_t>(seed << 13)) >> 32);   // * 2^41
  const std::uint32_t inverse = (seed << 14) + static_cast<std::uint32_t>(correction >> 11);  // 1/d * 2^30
  // 1 / interval = 1/d * 2^(shift - 32) / ns; 1e9 * 2^10 brings it to 1/s with 10 fraction bits.
  const auto rate = static_cast<std::uint32_t>((std::uint64_t{inverse} * 4000000000u) >> 32);  // * 2^(22 - shift)
  const int down = 22 - shift;
  return Rate::from_bounded_raw(static_cast<std::int64_t>((rate + ((1u << down) >> 1)) >> down));
}

}  // namespace stiction
