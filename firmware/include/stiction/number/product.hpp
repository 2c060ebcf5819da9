// Products of two 64-bit numbers with all of their 128 bits, shifted back to a word: for ways, speeds and accelerations
// of motions that are coupled to a master, whose product no 64-bit word holds. Four products of 32 bits, the same bits
// on every target, and no step whose work depends on the numbers.
#pragma once

#include <cstdint>

namespace stiction {

// |x|; that of the lowest number too.
constexpr std::uint64_t magnitude(std::int64_t x) {
  return x < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(x) : static_cast<std::uint64_t>(x);
}

// a * b * 2^-shift to the nearest whole number, ties away from zero; what exceeds a word is its end. `a`, `b`: any;
// `shift`: 0 to 127.
[[gnu::always_inline]] constexpr std::int64_t product_inlined(std::int64_t a, std::int64_t b, int shift) {
  const std::uint64_t x = magnitude(a), y = magnitude(b);
  const std::uint64_t x0 = x & 0xffffffffu, x1 = x >> 32, y0 = y & 0xffffffffu, y1 = y >> 32;
  const std::uint64_t low = x0 * y0, first = x1 * y0 + (low >> 32), second = x0 * y1 + (first & 0xffffffffu);
  const std::uint64_t upper = x1 * y1 + (first >> 32) + (second >> 32);
  const std::uint64_t lower = (second << 32) | (low & 0xffffffffu);
  constexpr auto most = static_cast<std::uint64_t>(INT64_MAX);
  // What is shifted out but for its last bit, which rounds.
  std::uint64_t result = 0;
  if (shift > 64) {
    result = ((upper >> (shift - 65)) + 1) >> 1;
  } else if (shift > 0) {
    const std::uint64_t twice = (lower >> (shift - 1)) | ((upper << (64 - shift)) << 1);
    const bool beyond = upper >> (shift - 1) != 0 || twice == UINT64_MAX;
    result = beyond ? most : (twice + 1) >> 1;
  } else {
    result = upper != 0 || lower > most ? most : lower;
  }
  return (a < 0) != (b < 0) ? -static_cast<std::int64_t>(result) : static_cast<std::int64_t>(result);
}

// As product_inlined() of `a`, `b` and `shift`, as a function of its own.
[[gnu::noinline]] constexpr std::int64_t product_shifted(std::int64_t a, std::int64_t b, int shift) {
  return product_inlined(a, b, shift);
}

// The same with a shift that is known, 1 to 127: on a 32-bit machine half of the instructions.
template <int Shift>
[[gnu::always_inline]] constexpr std::int64_t product(std::int64_t a, std::int64_t b) {
  static_assert(Shift >= 1 && Shift <= 127);
  return product_inlined(a, b, Shift);
}

// a * b * 2^-shift to the nearest whole number, ties up, of two numbers up to 2^62 whose result is within a word: half
// of the instructions of product_shifted(). `a`, `b`: so; `shift`: 32 to 63.
[[gnu::always_inline]] constexpr std::int64_t product_within(std::int64_t a, std::int64_t b, int shift) {
  const std::int64_t a1 = static_cast<std::int32_t>(a >> 32), b1 = static_cast<std::int32_t>(b >> 32);
  const std::uint64_t a0 = static_cast<std::uint32_t>(a), b0 = static_cast<std::uint32_t>(b);
  const std::int64_t first = a1 * static_cast<std::int64_t>(b0), second = b1 * static_cast<std::int64_t>(a0);
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  const std::uint64_t low = a0 * b0 + static_cast<std::uint32_t>(half);
  const auto middle = static_cast<std::int64_t>(static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(second) +
                                                (low >> 32) + (half >> 32));
  const auto upper = static_cast<std::uint64_t>(a1 * b1) << (64 - shift);
  return static_cast<std::int64_t>(upper + static_cast<std::uint64_t>(middle >> (shift - 32)));
}

// a * b of two numbers that are not negative; what exceeds a word is its end. Four products of 32 bits at most, and a
// third of the instructions of product_shifted() with a shift of 0.
[[gnu::always_inline]] constexpr std::int64_t product_held(std::int64_t a, std::int64_t b) {
  const auto x = static_cast<std::uint64_t>(a), y = static_cast<std::uint64_t>(b);
  const std::uint64_t x0 = x & 0xffffffffu, x1 = x >> 32, y0 = y & 0xffffffffu, y1 = y >> 32;
  const std::uint64_t middle = x1 * y0 + x0 * y1, low = x0 * y0, sum = (middle << 32) + low;
  // With a middle below 2^31 one of the lower halves is, or there is no upper one: the sum does not wrap.
  const bool beyond = (x1 != 0 && y1 != 0) || middle >> 31 != 0 || sum >> 63 != 0;
  return beyond ? INT64_MAX : static_cast<std::int64_t>(sum);
}

// a * b * 2^-Shift of a word `b`, rounded down; Shift 33 to 63, `a` below 2^62. Two products of 32 bits.
template <int Shift>
constexpr std::int64_t product_by_word(std::int64_t a, std::int32_t b) {
  static_assert(Shift >= 33 && Shift <= 63);
  const std::int64_t upper = std::int64_t{static_cast<std::int32_t>(a >> 32)} * b;
  const std::int64_t lower = std::int64_t{static_cast<std::uint32_t>(a)} * b;
  return (upper + (lower >> 32)) >> (Shift - 32);
}

}  // namespace stiction
