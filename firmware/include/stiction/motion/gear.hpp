// A gear between master and slave whose ratio is a fraction, exact for ever: the slave's place is computed from the
// master's whole one in each tick, not summed up, so that there is nothing that could drift, whatever the master does.
//
// As a curve to follow (cam_curve.hpp) it is a straight line; MC_GearIn and MC_GearInPos are engagements to it.
#pragma once

#include <cstdint>

#include "stiction/motion/master_position.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

class GearRatio {
 public:
  constexpr GearRatio() = default;

  // The `numerator` of either sign over the `denominator`, above 0: cycles behind the gear for one before it. A
  // denominator of 16 bits, as PLCopen has it, makes all divisions those of one word.
  constexpr GearRatio(std::int32_t numerator, std::uint16_t denominator)
      : numerator_(numerator), denominator_(denominator == 0 ? std::uint16_t{1} : denominator) {
    std::uint64_t size = 0;
    std::uint32_t rest = 0;
    const std::uint64_t scaled = magnitude(numerator_) << factor_bits;
    for (int shift = 48; shift >= 0; shift -= 16) {
      const std::uint32_t part = rest << 16 | (static_cast<std::uint32_t>(scaled >> shift) & word);
      size = size << 16 | part / denominator_;
      rest = part % denominator_;
    }
    factor_ = numerator_ < 0 ? -static_cast<std::int64_t>(size) : static_cast<std::int64_t>(size);
  }

  constexpr std::int32_t numerator() const { return numerator_; }
  constexpr std::uint16_t denominator() const { return denominator_; }
  // The ratio in 2^-32, rounded towards zero: for speeds.
  constexpr std::int64_t factor() const { return factor_; }

  // numerator * master / denominator, rounded down to 2^-64 cycles. `master`: up to 2^62 cycles over the ratio.
  constexpr MasterPosition position(const MasterPosition& master) const {
    if (unity()) return master;
    const bool back = master.cycles < 0;
    const MasterPosition size = back ? -master : master;
    const auto cycles = static_cast<std::uint64_t>(size.cycles);
    // From the least significant half word on the product, and from the most significant one on its quotient.
    const std::uint32_t times = static_cast<std::uint32_t>(magnitude(numerator_));
    std::uint32_t product[half_words] = {};
    std::uint64_t carry = 0;
    for (int k = 0; k < half_words; ++k) {
      const std::uint64_t from = k < 4 ? size.phase >> 16 * k : k < 8 ? cycles >> 16 * (k - 4) : 0;
      carry += std::uint64_t{static_cast<std::uint32_t>(from) & word} * times;
      product[k] = static_cast<std::uint32_t>(carry) & word;
      carry >>= 16;
    }
    std::uint32_t rest = 0;
    std::uint64_t quotient[2] = {};
    for (int k = half_words - 1; k >= 0; --k) {
      const std::uint32_t part = rest << 16 | product[k];
      // What is above 64 bits of cycles is nothing within the range.
      if (k < 8) quotient[k / 4] = quotient[k / 4] << 16 | part / denominator_;
      rest = part % denominator_;
    }
    const MasterPosition floor{static_cast<std::int64_t>(quotient[1]), quotient[0]};
    const bool negative = back != (numerator_ < 0);
    if (!negative) return floor;
    return rest == 0 ? -floor : -(floor + MasterPosition::fine(1));
  }

  // A `master` as it is behind the gear.
  constexpr MasterPoint of(const MasterPoint& master) const {
    if (unity()) return master;
    return {position(master.position), product<factor_bits>(master.velocity, factor_),
            product<factor_bits>(master.acceleration, factor_)};
  }

 private:
  constexpr bool unity() const { return numerator_ == 1 && denominator_ == 1; }

  static constexpr int factor_bits = 32, half_words = 10;
  static constexpr std::uint32_t word = 0xffffu;

  std::int32_t numerator_ = 1;
  std::uint16_t denominator_ = 1;
  std::int64_t factor_ = std::int64_t{1} << factor_bits;
};

}  // namespace stiction
