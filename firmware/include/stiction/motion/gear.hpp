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
    // From the least significant word on the product, and from the most significant one on its quotient.
    const std::uint64_t times = magnitude(numerator_);
    std::uint32_t product[5] = {};
    std::uint64_t carry = 0;
    const auto next = [&](std::uint64_t digits) {
      carry += static_cast<std::uint32_t>(digits) * times;
      const auto digit = static_cast<std::uint32_t>(carry);
      carry >>= 32;
      return digit;
    };
    product[0] = next(size.phase);
    product[1] = next(size.phase >> 32);
    product[2] = next(cycles);
    product[3] = next(cycles >> 32);
    product[4] = next(0);
    std::uint32_t rest = 0;
    const auto half = [&](std::uint32_t digit) {
      const std::uint32_t part = rest << 16 | digit, quotient = part / denominator_;
      rest = part - quotient * denominator_;
      return quotient;
    };
    const auto divided = [&](std::uint32_t digit) {
      const std::uint32_t upper = half(digit >> 16);
      return std::uint64_t{upper << 16 | half(digit & word)};
    };
    // What is above 64 bits of cycles is nothing within the range.
    static_cast<void>(divided(product[4]));
    std::uint64_t quotient[2] = {};
    quotient[1] = divided(product[3]) << 32;
    quotient[1] |= divided(product[2]);
    quotient[0] = divided(product[1]) << 32;
    quotient[0] |= divided(product[0]);
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

  static constexpr int factor_bits = 32;
  static constexpr std::uint32_t word = 0xffffu;

  std::int32_t numerator_ = 1;
  std::uint16_t denominator_ = 1;
  std::int64_t factor_ = std::int64_t{1} << factor_bits;
};

}  // namespace stiction
