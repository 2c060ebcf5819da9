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

  // The `numerator` of either sign over the `denominator`, above 0: cycles behind the gear for one before it.
  constexpr GearRatio(std::int32_t numerator, std::uint32_t denominator)
      : numerator_(numerator), denominator_(denominator == 0 ? 1 : denominator) {
    const std::uint64_t whole = magnitude(numerator_) / denominator_, rest = magnitude(numerator_) % denominator_;
    const auto size = static_cast<std::int64_t>(whole << factor_bits | ((rest << factor_bits) / denominator_));
    factor_ = numerator_ < 0 ? -size : size;
  }

  constexpr std::int32_t numerator() const { return numerator_; }
  constexpr std::uint32_t denominator() const { return denominator_; }
  // The ratio in 2^-32, rounded towards zero: for speeds.
  constexpr std::int64_t factor() const { return factor_; }

  // numerator * master / denominator, rounded down to 2^-64 cycles. `master`: up to 2^62 cycles over the ratio.
  constexpr MasterPosition position(const MasterPosition& master) const {
    if (numerator_ == 1 && denominator_ == 1) return master;
    const bool back = master.cycles < 0;
    const MasterPosition size = back ? -master : master;
    const auto cycles = static_cast<std::uint64_t>(size.cycles);
    // From the least significant: five words of the product, and from the most significant on their quotient.
    const std::uint64_t words[4] = {size.phase & word, size.phase >> 32, cycles & word, cycles >> 32};
    const std::uint64_t times = magnitude(numerator_);
    std::uint64_t product[5] = {}, carry = 0;
    for (int k = 0; k < 4; ++k) {
      carry += words[k] * times;
      product[k] = carry & word;
      carry >>= 32;
    }
    product[4] = carry;
    std::uint64_t rest = 0;
    for (int k = 4; k >= 0; --k) {
      const std::uint64_t part = rest << 32 | product[k];
      product[k] = part / denominator_;
      rest = part % denominator_;
    }
    const MasterPosition floor{static_cast<std::int64_t>(product[3] << 32 | product[2]), product[1] << 32 | product[0]};
    const bool negative = back != (numerator_ < 0);
    if (!negative) return floor;
    return rest == 0 ? -floor : -(floor + MasterPosition::fine(1));
  }

  // A `master` as it is behind the gear.
  constexpr MasterPoint of(const MasterPoint& master) const {
    return {position(master.position), product_shifted(master.velocity, factor_, factor_bits),
            product_shifted(master.acceleration, factor_, factor_bits)};
  }

 private:
  static constexpr int factor_bits = 32;
  static constexpr std::uint64_t word = 0xffffffffu;

  std::int32_t numerator_ = 1;
  std::uint32_t denominator_ = 1;
  std::int64_t factor_ = std::int64_t{1} << factor_bits;
};

}  // namespace stiction
