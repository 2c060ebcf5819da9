// The arithmetic of friction laws and motors on batches: each lane has the bits that sim/number gives for its double.
// In the namespace of the type, where the laws' calls find it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

#include "firmware/machine/batch/batch.hpp"
#include "sim/number/sine_table.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::machine {

template <class Isa>
STICTION_INLINE Batch<Isa> exponential(Batch<Isa> x) {
  constexpr double high = 0x1.62e42feep-1, low = 0x1.a39ef35793c76p-33;
  const auto turns = x * 0x1.71547652b82fep+0;
  const auto k = truncated(select(turns < 0.0, turns - 0.5, turns + 0.5));
  const auto r = (x - k * high) - k * low;
  Batch<Isa> sum = 1.0;
  for (int n = 13; n > 0; --n) sum = 1.0 + r / n * sum;
  const auto inside = sum * power_of_two(k);
  return select(x < -708.0, Batch<Isa>(0.0),
                select(x > 709.0, Batch<Isa>(std::numeric_limits<double>::infinity()), inside));
}

template <class Isa>
STICTION_INLINE Batch<Isa> series_divisor(Batch<Isa> a) {
  return 1.0 + a * (sim::detail::divisor_c1 + a * sim::detail::divisor_c2);
}

// Lanes that need no halving are not touched by those that do.
template <class Isa>
STICTION_INLINE Batch<Isa> one_minus_exp(Batch<Isa> a) {
  Batch<Isa> doublings = 0.0;
  auto longer = a > sim::detail::longest;
  a = select(longer && a > 64.0, Batch<Isa>(64.0), a);
  for (; any(longer); longer = a > sim::detail::longest) {
    a = select(longer, a * 0.5, a);
    doublings += longer;
  }
  auto s = a / series_divisor(a);
  for (auto rest = doublings > 0.0; any(rest); rest = doublings > 0.0) {
    s = select(rest, s + s * (1.0 - s), s);
    doublings = doublings - select(rest, Batch<Isa>(1.0), Batch<Isa>(0.0));
  }
  return s;
}

template <class Isa>
STICTION_INLINE Batch<Isa> relaxation_divisor(Batch<Isa> a) {
  const auto longer = a > sim::detail::longest;
  const auto series = series_divisor(a);
  if (any(longer)) [[unlikely]]
    return select(longer, a / one_minus_exp(a), series);
  return series;
}

template <class Isa>
struct SineCosineOf {
  Batch<Isa> sine, cosine;
};

template <class Isa>
STICTION_INLINE SineCosineOf<Isa> sine_cosine(Batch<Isa> angle) {
  constexpr double no_fraction = 0x1.8p52;
  const auto shifted = angle * (sim::detail::directions / (2.0 * std::numbers::pi)) + no_fraction;
  const auto turned = shifted - no_fraction;
  Batch<Isa> s, c;
  for (std::size_t k = 0; k < Batch<Isa>::lanes; ++k) {
    const auto& direction =
        sim::detail::direction[__builtin_bit_cast(std::uint64_t, shifted.lane(k)) % sim::detail::directions];
    s.set_lane(k, direction.sine);
    c.set_lane(k, direction.cosine);
  }
  constexpr double first = 0x1.921fb58p-7, rest = -0x1.dde973dcb3b3ap-34;
  const auto r = (angle - turned * first) - turned * rest;
  const auto z = r * r;
  const auto sine = r + r * z * (-1.0 / 6.0 + z * (1.0 / 120.0));
  const auto versine = z * (-0.4999999999988926 + z * 0.04166658823009808);
  return {s + (c * sine + s * versine), c + (c * versine - s * sine)};
}

}  // namespace stiction::machine
