// Fixed-point numbers with the binary point in the type. One rule of rounding (to nearest, ties away from zero) and
// one of overflow (saturate, and count it), both in narrow(). Everything else is exact: sums and products are Wide,
// whose largest magnitude is part of the type, so that an expression which could overflow 64 bits does not compile.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>
#include <type_traits>

namespace stiction {

// How often a result had to be saturated.
struct SaturationCounter {
  std::uint64_t count = 0;

  constexpr void add() { ++count; }
  constexpr void add(const SaturationCounter& other) { count += other.count; }
};

// A 64-bit number raw * 2^-FractionBits with |raw| <= Bound, exact results of sums and products. As a format to narrow
// to, a bound of 2^62 is itself out of range, as for a word: the two upper bits then tell.
template <int FractionBits, std::uint64_t Bound>
class Wide {
  static_assert(Bound <= static_cast<std::uint64_t>(INT64_MAX),
                "Wide: this sum, product or alignment may overflow 64 bits; narrow an operand first");

 public:
  static constexpr int fraction_bits = FractionBits;
  static constexpr std::uint64_t bound = Bound;
  static constexpr std::int64_t lowest_raw = -static_cast<std::int64_t>(Bound);
  static constexpr std::int64_t highest_raw = static_cast<std::int64_t>(Bound) - (Bound == std::uint64_t{1} << 62);

  constexpr Wide() = default;

  // Values beyond the bound are clamped to it, so that the bound holds for every object.
  static constexpr Wide from_raw(std::int64_t raw) {
    return Wide(raw < lowest_raw ? lowest_raw : raw > highest_raw ? highest_raw : raw);
  }
  // For results that hold the bound by construction.
  static constexpr Wide from_bounded_raw(std::int64_t raw) { return Wide(raw); }
  constexpr std::int64_t raw() const { return raw_; }

  constexpr Wide operator-() const { return Wide(-raw_); }
  friend constexpr auto operator<=>(const Wide&, const Wide&) = default;

 private:
  explicit constexpr Wide(std::int64_t raw) : raw_(raw) {}
  std::int64_t raw_ = 0;
};

// A 32-bit number raw * 2^-FractionBits: signals.
template <int FractionBits>
class Fixed {
 public:
  static constexpr int fraction_bits = FractionBits;
  static constexpr std::uint64_t bound = std::uint64_t{1} << 31;
  static constexpr std::int64_t lowest_raw = INT32_MIN;
  static constexpr std::int64_t highest_raw = INT32_MAX;

  constexpr Fixed() = default;
  static constexpr Fixed from_raw(std::int32_t raw) { return Fixed(raw); }
  static constexpr Fixed from_bounded_raw(std::int64_t raw) { return Fixed(static_cast<std::int32_t>(raw)); }
  constexpr std::int32_t raw() const { return raw_; }

  friend constexpr auto operator<=>(const Fixed&, const Fixed&) = default;

 private:
  explicit constexpr Fixed(std::int32_t raw) : raw_(raw) {}
  std::int32_t raw_ = 0;
};

// A configured constant with |raw| <= 2^Bits. The unused bits of the word are the headroom that lets several products
// share one accumulator. It is kept in a word of the machine's own width: a 64-bit machine multiplies by it right from
// memory.
template <int FractionBits, int Bits = 30>
class Coefficient {
  static_assert(Bits > 0 && Bits <= 30, "Coefficient: 1 to 30 bits of magnitude");

 public:
  using Raw = std::int_fast32_t;
  static constexpr int fraction_bits = FractionBits;
  static constexpr std::uint64_t bound = std::uint64_t{1} << Bits;
  static constexpr std::int64_t lowest_raw = -(std::int64_t{1} << Bits);
  static constexpr std::int64_t highest_raw = std::int64_t{1} << Bits;

  constexpr Coefficient() = default;
  // Values beyond the bound are clamped to it.
  static constexpr Coefficient from_raw(std::int32_t raw) {
    return Coefficient(static_cast<Raw>(raw < lowest_raw ? lowest_raw : raw > highest_raw ? highest_raw : raw));
  }
  static constexpr Coefficient from_bounded_raw(std::int64_t raw) { return Coefficient(static_cast<Raw>(raw)); }
  constexpr std::int32_t raw() const { return static_cast<std::int32_t>(raw_); }
  constexpr Raw factor() const { return raw_; }  // the same in the width that multiplies fastest

  friend constexpr auto operator<=>(const Coefficient&, const Coefficient&) = default;

 private:
  explicit constexpr Coefficient(Raw raw) : raw_(raw) {}
  Raw raw_ = 0;
};

template <class T>
concept FixedPoint = requires(T x) {
  { T::fraction_bits } -> std::convertible_to<int>;
  { T::bound } -> std::convertible_to<std::uint64_t>;
  x.raw();
};

namespace detail {

// The bound of a product, or a value that Wide refuses when it exceeds 64 bits.
constexpr std::uint64_t product_bound(std::uint64_t a, std::uint64_t b) {
  return a != 0 && b > UINT64_MAX / a ? UINT64_MAX : a * b;
}
constexpr std::uint64_t aligned_bound(std::uint64_t bound, int shift) {
  return shift > 63 || bound > (UINT64_MAX >> shift) ? UINT64_MAX : bound << shift;
}
constexpr std::uint64_t sum_bound(std::uint64_t a, std::uint64_t b) { return a > UINT64_MAX - b ? UINT64_MAX : a + b; }

// Whether `raw` is in the range of Out. That of a whole word is seen by cutting to it and that of 63 bits by the two
// upper ones, in fewer instructions than by two comparisons of 64 bits.
template <FixedPoint Out>
constexpr bool within(std::int64_t raw) {
  if constexpr (Out::highest_raw == INT32_MAX && Out::lowest_raw == INT32_MIN)
    return raw == static_cast<std::int32_t>(raw);
  else if constexpr (Out::bound == std::uint64_t{1} << 62)
    return (raw ^ (raw << 1)) >= 0;
  else
    return raw <= Out::highest_raw && raw >= Out::lowest_raw;
}

// raw * 2^-Shift to the nearest whole number, ties away from zero: adding a half, and one less for negative numbers,
// makes the floor of the shift do that. On a 32-bit machine an addend of one word is cheaper.
template <int Shift>
constexpr std::int64_t shift_rounding(std::int64_t raw) {
  constexpr std::int64_t half = std::int64_t{1} << (Shift - 1);
  if constexpr (sizeof(void*) == 4 && Shift <= 31)
    raw += static_cast<std::uint32_t>(static_cast<std::int32_t>(half) + static_cast<std::int32_t>(raw >> 63));
  else
    raw += half + (raw >> 63);
  return raw >> Shift;
}

// On a 32-bit machine: what the compiler deduced of a factor's 64 bits is forgotten, so that a product of two words is
// one instruction. Without this an axis takes an eighth more of them on Cortex-M4.
template <class Word>
constexpr Word opaque(Word x) {
  if constexpr (sizeof(void*) == 4 && sizeof(Word) == 4)
    if (!std::is_constant_evaluated()) asm("" : "+r"(x));
  return x;
}

template <FixedPoint T>
constexpr auto factor(T x) {
  return x.raw();
}
template <int FractionBits, int Bits>
constexpr auto factor(Coefficient<FractionBits, Bits> x) {
  return x.factor();
}

template <int FractionBits, FixedPoint T>
constexpr auto align(T x) {
  constexpr int shift = FractionBits - T::fraction_bits;
  static_assert(shift >= 0);
  return Wide<FractionBits, aligned_bound(T::bound, shift)>::from_bounded_raw(std::int64_t{x.raw()} *
                                                                              (std::int64_t{1} << shift));
}

}  // namespace detail

// Exact product.
template <FixedPoint A, FixedPoint B>
constexpr auto operator*(A a, B b) {
  return Wide<A::fraction_bits + B::fraction_bits, detail::product_bound(A::bound, B::bound)>::from_bounded_raw(
      std::int64_t{detail::opaque(detail::factor(a))} * std::int64_t{detail::opaque(detail::factor(b))});
}

// Exact sum; the operand with fewer fraction bits is aligned to the other.
template <FixedPoint A, FixedPoint B>
constexpr auto operator+(A a, B b) {
  constexpr int bits = A::fraction_bits > B::fraction_bits ? A::fraction_bits : B::fraction_bits;
  const auto x = detail::align<bits>(a);
  const auto y = detail::align<bits>(b);
  return Wide<bits, detail::sum_bound(decltype(x)::bound, decltype(y)::bound)>::from_bounded_raw(x.raw() + y.raw());
}

template <FixedPoint A, FixedPoint B>
constexpr auto operator-(A a, B b) {
  constexpr int bits = A::fraction_bits > B::fraction_bits ? A::fraction_bits : B::fraction_bits;
  const auto x = detail::align<bits>(a);
  const auto y = detail::align<bits>(b);
  return Wide<bits, detail::sum_bound(decltype(x)::bound, decltype(y)::bound)>::from_bounded_raw(x.raw() - y.raw());
}

// Rounds `x` to the fraction bits of `Out`, by the rule of narrow(), without saturation.
template <FixedPoint Out, FixedPoint In>
constexpr auto round_to(In x) {
  constexpr int shift = In::fraction_bits - Out::fraction_bits;
  static_assert(shift > 0 && In::bound <= static_cast<std::uint64_t>(INT64_MAX) - (std::uint64_t{1} << (shift - 1)),
                "round_to: this value may overflow 64 bits");
  return Wide<Out::fraction_bits, (In::bound >> shift) + 1>::from_bounded_raw(detail::shift_rounding<shift>(x.raw()));
}

// `x` in a format that is known to hold it.
template <FixedPoint Out, FixedPoint In>
constexpr Out cut(In x) {
  static_assert(In::fraction_bits == Out::fraction_bits);
  return Out::from_bounded_raw(x.raw());
}

// Rounds `x` to the format of `Out` (to nearest, ties away from zero), saturates to its range and counts that. Where
// the types show that the range cannot be left, no comparison is compiled.
template <FixedPoint Out, FixedPoint In>
constexpr Out narrow(In x, SaturationCounter& saturations) {
  constexpr int shift = In::fraction_bits - Out::fraction_bits;
  std::int64_t raw = x.raw();
  std::uint64_t constexpr bound =
      shift >= 0 ? (shift > 63 ? 0 : (In::bound >> shift) + 1) : detail::aligned_bound(In::bound, -shift);
  if constexpr (shift > 0) {
    static_assert(shift < 63 && In::bound <= static_cast<std::uint64_t>(INT64_MAX) - (std::uint64_t{1} << (shift - 1)),
                  "narrow: rounding this value may overflow 64 bits");
    raw = detail::shift_rounding<shift>(raw);
  } else if constexpr (shift < 0) {
    static_assert(bound <= static_cast<std::uint64_t>(INT64_MAX), "narrow: this alignment may overflow 64 bits");
    raw *= std::int64_t{1} << -shift;
  }
  // What is put in the place of a result out of range has the width of Out: one word stays one word.
  using Raw = decltype(Out{}.raw());
  auto out = static_cast<Raw>(raw);
  if constexpr (bound > static_cast<std::uint64_t>(Out::highest_raw)) {
    if (!detail::within<Out>(raw)) [[unlikely]] {
      out = static_cast<Raw>(x.raw() < 0 ? Out::lowest_raw : Out::highest_raw);
      saturations.add();
    }
  }
  return Out::from_bounded_raw(out);
}

// |x| > bound, exact; the bound is not negative. One comparison: what lies beyond the bound on either side wraps above
// twice the bound.
template <int FractionBits, std::uint64_t Bound>
constexpr bool exceeds(Wide<FractionBits, Bound> x, Fixed<FractionBits> bound) {
  const auto limit = static_cast<std::uint64_t>(bound.raw());
  return static_cast<std::uint64_t>(x.raw()) + limit > 2 * limit;
}

// -x; the one value without an opposite, the lowest of a word, gives the highest.
template <int FractionBits>
constexpr Fixed<FractionBits> opposite(Fixed<FractionBits> x) {
  return Fixed<FractionBits>::from_raw(x.raw() == INT32_MIN ? INT32_MAX : -x.raw());
}

// -x of a number that is not the lowest of its word, such as a bound.
template <int FractionBits>
constexpr Fixed<FractionBits> negative(Fixed<FractionBits> x) {
  return Fixed<FractionBits>::from_raw(-x.raw());
}

// narrow(a + b) and narrow(a - b) of one format, in the two instructions that a word's overflow flag allows.
// `saturations`: counts results that exceed the format.
template <int FractionBits>
constexpr Fixed<FractionBits> saturated_sum(Fixed<FractionBits> a, Fixed<FractionBits> b,
                                            SaturationCounter& saturations) {
  std::int32_t raw = 0;
  if (__builtin_add_overflow(a.raw(), b.raw(), &raw)) [[unlikely]] {
    raw = a.raw() < 0 ? INT32_MIN : INT32_MAX;
    saturations.add();
  }
  return Fixed<FractionBits>::from_raw(raw);
}

// As saturated_sum(), of `a` minus `b`; `saturations`: counts results that exceed the format.
template <int FractionBits>
constexpr Fixed<FractionBits> saturated_difference(Fixed<FractionBits> a, Fixed<FractionBits> b,
                                                   SaturationCounter& saturations) {
  std::int32_t raw = 0;
  if (__builtin_sub_overflow(a.raw(), b.raw(), &raw)) [[unlikely]] {
    raw = a.raw() < 0 ? INT32_MIN : INT32_MAX;
    saturations.add();
  }
  return Fixed<FractionBits>::from_raw(raw);
}

// |x| > bound, exact; the bound is not negative. One comparison: what lies beyond the bound on either side wraps above
// twice the bound.
template <int FractionBits>
constexpr bool exceeds(Fixed<FractionBits> x, Fixed<FractionBits> bound) {
  const auto limit = static_cast<std::uint32_t>(bound.raw());
  return static_cast<std::uint32_t>(x.raw()) + limit > 2 * limit;
}

}  // namespace stiction
