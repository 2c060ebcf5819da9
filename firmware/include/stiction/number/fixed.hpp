// Fixed-point numbers with the binary point in the type. One rule of rounding (to nearest, ties away from zero) and
// one of overflow (saturate, and count it), both in narrow(). Everything else is exact: sums and products are Wide,
// whose largest magnitude is part of the type, so that an expression which could overflow 64 bits does not compile.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>

namespace stiction {

// How often narrow() had to saturate.
struct SaturationCounter {
  std::uint32_t count = 0;

  constexpr void add() { count += count != UINT32_MAX; }
  constexpr void add(const SaturationCounter& other) {
    count = count > UINT32_MAX - other.count ? UINT32_MAX : count + other.count;
  }
};

// A 64-bit number raw * 2^-FractionBits with |raw| <= Bound, exact results of sums and products.
template <int FractionBits, std::uint64_t Bound>
class Wide {
  static_assert(Bound <= static_cast<std::uint64_t>(INT64_MAX),
                "Wide: this sum, product or alignment may overflow 64 bits; narrow an operand first");

 public:
  static constexpr int fraction_bits = FractionBits;
  static constexpr std::uint64_t bound = Bound;
  static constexpr std::int64_t lowest_raw = -static_cast<std::int64_t>(Bound);
  static constexpr std::int64_t highest_raw = static_cast<std::int64_t>(Bound);

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
// share one accumulator.
template <int FractionBits, int Bits = 30>
class Coefficient {
  static_assert(Bits > 0 && Bits <= 30, "Coefficient: 1 to 30 bits of magnitude");

 public:
  static constexpr int fraction_bits = FractionBits;
  static constexpr std::uint64_t bound = std::uint64_t{1} << Bits;
  static constexpr std::int64_t lowest_raw = -(std::int64_t{1} << Bits);
  static constexpr std::int64_t highest_raw = std::int64_t{1} << Bits;

  constexpr Coefficient() = default;
  // Values beyond the bound are clamped to it.
  static constexpr Coefficient from_raw(std::int32_t raw) {
    return Coefficient(static_cast<std::int32_t>(raw < lowest_raw    ? lowest_raw
                                                 : raw > highest_raw ? highest_raw
                                                                     : raw));
  }
  static constexpr Coefficient from_bounded_raw(std::int64_t raw) {
    return Coefficient(static_cast<std::int32_t>(raw));
  }
  constexpr std::int32_t raw() const { return raw_; }

  friend constexpr auto operator<=>(const Coefficient&, const Coefficient&) = default;

 private:
  explicit constexpr Coefficient(std::int32_t raw) : raw_(raw) {}
  std::int32_t raw_ = 0;
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

// Whether `raw` is in the range of Out. That of a whole word is seen by cutting to it, in fewer instructions than by
// two comparisons of 64 bits.
template <FixedPoint Out>
constexpr bool within(std::int64_t raw) {
  if constexpr (Out::highest_raw == INT32_MAX && Out::lowest_raw == INT32_MIN)
    return raw == static_cast<std::int32_t>(raw);
  else
    return raw <= Out::highest_raw && raw >= Out::lowest_raw;
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
      std::int64_t{a.raw()} * std::int64_t{b.raw()});
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
    // Adding a half and one less for negative numbers makes the floor of the shift round ties away from zero.
    raw = (raw + (std::int64_t{1} << (shift - 1)) + (raw >> 63)) >> shift;
  } else if constexpr (shift < 0) {
    static_assert(bound <= static_cast<std::uint64_t>(INT64_MAX), "narrow: this alignment may overflow 64 bits");
    raw *= std::int64_t{1} << -shift;
  }
  if constexpr (bound > static_cast<std::uint64_t>(Out::highest_raw)) {
    if (!detail::within<Out>(raw)) [[unlikely]] {
      raw = raw < 0 ? Out::lowest_raw : Out::highest_raw;
      saturations.add();
    }
  }
  return Out::from_bounded_raw(raw);
}

// -x; the one value without an opposite, the lowest of a word, gives the highest.
template <int FractionBits>
constexpr Fixed<FractionBits> opposite(Fixed<FractionBits> x) {
  return Fixed<FractionBits>::from_raw(x.raw() == INT32_MIN ? INT32_MAX : -x.raw());
}

// |x| > bound, exact; the bound is not negative.
template <int FractionBits>
constexpr bool exceeds(Fixed<FractionBits> x, Fixed<FractionBits> bound) {
  const auto bits = static_cast<std::uint32_t>(x.raw());
  return (x.raw() < 0 ? 0u - bits : bits) > static_cast<std::uint32_t>(bound.raw());
}

}  // namespace stiction
