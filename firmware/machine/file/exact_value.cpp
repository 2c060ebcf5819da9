#include "firmware/machine/file/exact_value.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "firmware/machine/file/units.hpp"

namespace stiction::machine {
namespace {

std::optional<Fraction> within_limits(std::optional<Fraction> value) {
  if (!value || value->numerator < 1 || value->numerator > largest_in_file || value->denominator > largest_in_file)
    return std::nullopt;
  return value;
}

template <class Number>
std::optional<Number> whole(std::string_view digits) {
  Number number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

constexpr int most_decimals = 18;  // of 10^n in 64 bits

std::optional<Fraction> power_of_ten(int exponent) {
  if (std::abs(exponent) > most_decimals) return std::nullopt;
  std::int64_t power = 1;
  for (int k = 0; k < std::abs(exponent); ++k) power *= 10;
  return exponent < 0 ? Fraction{1, power} : Fraction{power, 1};
}

// "3.25", "+2", "1e-3".
std::optional<Fraction> decimal(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  int exponent = 0;
  if (const auto e = text.find_first_of("eE"); e != std::string_view::npos) {
    auto written = text.substr(e + 1);
    if (written.starts_with('+')) written.remove_prefix(1);
    const auto given = whole<int>(written);
    if (!given || std::abs(*given) > most_decimals) return std::nullopt;
    exponent = *given;
    text = text.substr(0, e);
  }
  std::string digits;
  bool behind_point = false;
  for (const char c : text) {
    if (c == '.' && !behind_point) {
      behind_point = true;
      continue;
    }
    if (c < '0' || c > '9') return std::nullopt;
    digits += c;
    if (behind_point) --exponent;
  }
  // Zeros at the end of a decimal say nothing: "3.2500000000000000000" is 3.25.
  while (behind_point && digits.size() > 1 && digits.back() == '0' && exponent < 0) {
    digits.pop_back();
    ++exponent;
  }
  const auto number = whole<std::int64_t>(digits);
  const auto power = power_of_ten(exponent);
  if (!number || *number < 1 || !power) return std::nullopt;
  return product({*number, 1}, *power);
}

// Of a unit of angle in turns, of any other in m.
std::optional<Fraction> exact_unit(std::string_view unit, std::string_view si_unit) {
  const double size = parse_quantity(fmt::format("1 {}", unit), si_unit);
  if (si_unit != "rad") return decimal(fmt::format("{}", size));
  const double in_turn = 2.0 * std::numbers::pi / size, nearest = std::round(in_turn);
  // Units of a turn are a whole part of it, as far as its digits tell: 1/360, 1/400, 1/1296000.
  if (!(nearest >= 1.0) || nearest > static_cast<double>(largest_in_file) ||
      std::abs(in_turn - nearest) > 1e-13 * nearest)
    return std::nullopt;
  return Fraction{1, static_cast<std::int64_t>(nearest)};
}

}  // namespace

std::optional<Fraction> exact_number(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return within_limits(decimal(text));
  const auto above = whole<std::int64_t>(text.substr(0, slash)), below = whole<std::int64_t>(text.substr(slash + 1));
  if (!above || !below || *above < 1 || *below < 1) return std::nullopt;
  return within_limits(fraction(*above, *below));
}

std::optional<Fraction> exact_number(const toml::node& node) {
  if (const auto* text = node.as_string()) return exact_number(text->get());
  if (const auto* number = node.as_integer()) return exact_number(fmt::format("{}", number->get()));
  if (const auto* number = node.as_floating_point()) return exact_number(fmt::format("{}", number->get()));
  return std::nullopt;
}

std::optional<Fraction> exact_quantity(const toml::node& node, std::string_view si_unit) {
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  const std::string_view whole_text = text->get(), unit = unit_of(whole_text);
  const auto first = whole_text.find_first_not_of(" \t");
  if (unit.empty() || first == std::string_view::npos) return std::nullopt;
  const auto blank = whole_text.find_first_of(" \t", first);
  const auto number = exact_number(whole_text.substr(first, blank - first));
  const auto factor = exact_unit(unit, si_unit);
  if (!number || !factor) return std::nullopt;
  return within_limits(product(*number, *factor));
}

}  // namespace stiction::machine
