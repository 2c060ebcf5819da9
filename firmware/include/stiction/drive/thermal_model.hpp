// I2t: the heating of a body of one time constant by the square of a current, u' = (i^2 / i_n^2 - u) / tau, where u = 1
// is the state to which the continuous current i_n leads (as in thermal electrical relays, IEC 60255-149). A step is
// exact for a square that is held over it.
// Integers: u with 40 fraction bits.
#pragma once

#include <cstdint>

#include "stiction/number/product.hpp"

namespace stiction {

class ThermalModel {
 public:
  static constexpr int fraction_bits = 40;
  static constexpr std::int64_t whole = std::int64_t{1} << fraction_bits;
  // Where the model trips: between 100 %, below which it never does, and 105 %.
  static constexpr std::int64_t trip = whole + whole / 40;
  static constexpr int share_bits = 56;

  struct Config {
    std::int64_t per_square = 0;  // u of one squared unit of current (raw * raw >> 20), 2^-40; 0: no model
    std::int64_t share = 0;       // of the difference that a step takes: step / tau, 2^-56
  };

  // A step. `square`: of the current, raw squared and cut by 20 bits; `config`: of the body.
  constexpr void step(const Config& config, std::int64_t square) {
    const std::int64_t drive = product<16>(square, config.per_square);
    state_ += product<share_bits>(drive - state_, config.share);
    if (state_ < 0) state_ = 0;
  }
  constexpr std::int64_t state() const { return state_; }
  constexpr bool tripped() const { return state_ >= trip; }
  constexpr bool warm() const { return state_ >= whole; }  // no reset as long as it is
  constexpr int percent() const { return static_cast<int>((state_ * 100) >> fraction_bits); }

 private:
  std::int64_t state_ = 0;
};

}  // namespace stiction
