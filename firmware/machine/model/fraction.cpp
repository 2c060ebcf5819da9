#include "firmware/machine/model/fraction.hpp"

#include <fmt/format.h>

#include <numeric>

namespace stiction::machine {

Fraction fraction(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t common = std::gcd(numerator, denominator);
  return {numerator / common, denominator / common};
}

std::optional<Fraction> product(const Fraction& a, const Fraction& b) {
  // What cancels is taken away first, so that only a result that is itself too large has no place.
  const Fraction first = fraction(a.numerator, b.denominator), second = fraction(b.numerator, a.denominator);
  Fraction result;
  if (__builtin_mul_overflow(first.numerator, second.numerator, &result.numerator) ||
      __builtin_mul_overflow(first.denominator, second.denominator, &result.denominator))
    return std::nullopt;
  return result;
}

std::optional<Fraction> quotient(const Fraction& a, const Fraction& b) {
  return product(a, {b.denominator, b.numerator});
}

std::string text_of(const Fraction& value) {
  return value.denominator == 1 ? fmt::format("{}", value.numerator)
                                : fmt::format("{}/{}", value.numerator, value.denominator);
}

}  // namespace stiction::machine
