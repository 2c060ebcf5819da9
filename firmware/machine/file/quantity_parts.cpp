#include "firmware/machine/file/quantity_parts.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>
#include <version>

#include "firmware/machine/file/units.hpp"

namespace stiction::machine {
namespace {

constexpr std::string_view blanks = " \t";

#ifdef __cpp_lib_to_chars
std::from_chars_result read_number(std::string_view text, double& number) {
  return std::from_chars(text.data(), text.data() + text.size(), number);
}
#else
// The page's library has no from_chars() of doubles; its strtod() has no locale, but reads more than decimal numbers.
std::from_chars_result read_number(std::string_view text, double& number) {
  const std::string digits(text.substr(0, text.find_first_not_of("+-.0123456789eEinfatyINFATY")));
  char* stop = nullptr;
  const double value = std::strtod(digits.c_str(), &stop);
  if (stop == digits.c_str() || digits.front() == '+') return {text.data(), std::errc::invalid_argument};
  const char* const end = text.data() + (stop - digits.c_str());
  const bool infinite = digits.find_first_of("iInN") != std::string::npos;
  if ((std::isinf(value) && !infinite) ||
      (value == 0.0 && digits.find_first_of("123456789") < digits.find_first_of("eE")))
    return {end, std::errc::result_out_of_range};
  number = value;
  return {end, std::errc{}};
}
#endif

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

double split_quantity(std::string_view text, std::string_view& unit) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = read_number(text, number);
  const std::string_view rest = text.substr(static_cast<std::size_t>(end - text.data()));
  if (error == std::errc::result_out_of_range) throw UnitError("beyond the range of numbers");
  if (error != std::errc{}) throw UnitError("not NUMBER UNIT");
  if (rest.size() > 1 && rest.front() == ',' && rest[1] >= '0' && rest[1] <= '9')
    throw UnitError("not NUMBER UNIT, for a decimal comma; numbers have a decimal point, as in \"8.5\"");
  if (!std::isfinite(number)) throw UnitError("not a finite number");
  if (!rest.empty() && blanks.find(rest.front()) == std::string_view::npos && rest.front() != '%')
    throw UnitError("not NUMBER UNIT with a blank between them");
  unit = trimmed(rest);
  return number;
}

std::string_view unit_of(std::string_view quantity) {
  std::string_view unit;
  try {
    split_quantity(quantity, unit);
  } catch (const UnitError&) {
    return {};
  }
  return unit;
}

double scaled(double number, double factor) {
  const double inverse = std::round(1.0 / factor);
  if (std::abs(factor) < 1.0 && std::abs(inverse * factor - 1.0) < 1e-14) return number / inverse;
  return number * factor;
}

}  // namespace stiction::machine
