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
  const int shift = std::countl_zero(bounded);
  const std::uint64_t normal = std::uint64_t{bounded} << shift;                      // d * 2^32, d in [1/2, 1)
  const std::uint64_t seed = UINT32_MAX / static_cast<std::uint32_t>(normal >> 16);  // 1/d * 2^16
  // r (2 - d r): seed and its residual d r carry 16 and 32 fraction bits.
  const std::uint64_t residual = (std::uint64_t{2} << 32) - ((normal * seed) >> 16);  // 2 - d r, * 2^32
  const std::uint64_t inverse = (seed * residual) >> 18;                              // 1/d * 2^30
  // 1 / interval = 1/d * 2^(shift - 32) / ns; 1e9 * 2^10 = 1.024e12 brings it to 1/s with 10 fraction bits.
  constexpr std::uint64_t scale = 1024000000000u >> 10;
  const int down = 30 - 10 + 32 - shift;
  const std::uint64_t product = inverse * scale;  // < 2^31 * 2^30
  return Rate::from_bounded_raw(static_cast<std::int64_t>((product + (std::uint64_t{1} << (down - 1))) >> down));
}

}  // namespace stiction
