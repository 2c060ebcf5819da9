// The border between double precision and the signal types, as a table by type: who has signals of another kind
// specialises Format for them. It refuses what is not a number or out of range, so that neither can enter the
// fixed-point side unseen. Usable while compiling; <cmath> is not needed.
#pragma once

#include <cstdint>

#include "stiction/design/problems.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction::design {

constexpr double power_of_two(int exponent) {
  double power = 1.0;
  for (; exponent > 0; --exponent) power *= 2.0;
  for (; exponent < 0; ++exponent) power *= 0.5;
  return power;
}

// The whole number nearest to `value`, ties away from zero; its magnitude must be below 2^52.
constexpr std::int64_t nearest(double value) {
  // Not 0.5 but the double before it: the sum's own rounding does the rest, and 0.5 would lift the double before a
  // half to the next whole number.
  return static_cast<std::int64_t>(value + __builtin_copysign(0x1.fffffffffffffp-2, value));
}

template <class T>
struct Format;

template <FixedPoint T>
struct Format<T> {
  // Writes `value` to `signal`, rounded to nearest, ties away from zero. False, and nothing written, when it is NaN or
  // beyond the format's range.
  static constexpr bool convert(double value, T& signal) {
    constexpr double scale = power_of_two(T::fraction_bits);
    constexpr double lowest_raw = static_cast<double>(T::lowest_raw), highest_raw = static_cast<double>(T::highest_raw);
    const double scaled = value * scale;
    if constexpr (T::bound > std::uint64_t{1} << 52) {  // doubles of that size are whole
      static_assert(T::bound <= std::uint64_t{1} << 61);
      if (!(__builtin_fabs(scaled) <= highest_raw)) return false;
    } else {
      if (!(scaled > lowest_raw - 0.5 && scaled < highest_raw + 0.5)) return false;
    }
    signal = T::from_bounded_raw(nearest(scaled));
    return true;
  }
  // The largest value that convert() takes.
  static constexpr double highest() { return static_cast<double>(T::highest_raw) * power_of_two(-T::fraction_bits); }
  static constexpr double to_si(T signal) {
    constexpr double scale = power_of_two(-T::fraction_bits);
    return static_cast<double>(signal.raw()) * scale;
  }
};

// `value`, SI, in the format T; where it is NaN or beyond the range, zero.
template <class T>
constexpr T to_signal(double value) {
  T signal{};
  return Format<T>::convert(value, signal) ? signal : T{};
}

// SI value of a signal.
template <class T>
constexpr double to_si(T signal) {
  return Format<T>::to_si(signal);
}

// Converts the parameters of a design and writes down those that the formats do not hold.
class Converter {
 public:
  explicit constexpr Converter(Problems& problems) : problems_(problems) {}

  // `value` in the format T; zero, with a problem, where it is NaN or beyond the range. `quantity`: its name and unit.
  template <class T>
  constexpr T operator()(double value, const Quantity& quantity) const {
    T signal{};
    if (!Format<T>::convert(value, signal))
      problems_.add(
          {quantity, value, "at most", Format<T>::highest(), " in magnitude, the range of the drive's number format"});
    return signal;
  }
  // The same of a gain: one that would round to nothing is refused too, it would act as zero.
  template <class T>
  constexpr T gain(double value, const Quantity& quantity) const {
    T signal{};
    if (!Format<T>::convert(value, signal)) return (*this).template operator()<T>(value, quantity);
    const double becomes = Format<T>::to_si(signal);
    if (value != 0.0 && __builtin_fabs(becomes / value - 1.0) > 0.01)
      problems_.add({quantity, value, "a value that the drive's number format resolves to 1 %, but it would become",
                     becomes, ""});
    return signal;
  }

  constexpr void refuse(const Problem& problem) const { problems_.add(problem); }

 private:
  Problems& problems_;
};

}  // namespace stiction::design
