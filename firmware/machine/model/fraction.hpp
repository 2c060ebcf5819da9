// Fractions of whole numbers: what a file says exactly and a double would round.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace stiction::machine {

// In lowest terms; the denominator is positive.
struct Fraction {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;

  friend bool operator==(const Fraction&, const Fraction&) = default;
};

// `numerator` over `denominator`, neither of them less than 1, in lowest terms.
Fraction fraction(std::int64_t numerator, std::int64_t denominator);

// Of positive fractions; none where a number of the result is beyond 64 bits with sign.
std::optional<Fraction> product(const Fraction& a, const Fraction& b);
std::optional<Fraction> quotient(const Fraction& a, const Fraction& b);

// "3550000/113", or "36000" of a whole number.
std::string text_of(const Fraction& value);

}  // namespace stiction::machine
