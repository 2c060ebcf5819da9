#include "firmware/machine/file/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/quantity_parts.hpp"

namespace stiction::machine {
namespace {

struct Free {
  void operator()(ut_unit* unit) const { ut_free(unit); }
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, Free>;
using Converter = std::unique_ptr<cv_converter, Free>;

// UDUNITS-2 keeps its state in globals.
std::mutex& library() {
  static std::mutex mutex;
  return mutex;
}

ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    ut_system* read = ut_read_xml(nullptr);
    if (read == nullptr) throw std::runtime_error("UDUNITS-2: the database of units (udunits2.xml) cannot be read");
    // The usual abbreviations of rotary axes, which the database lacks.
    for (const auto& [name, unit] : {std::pair{"deg", "arc_degree"}, std::pair{"rev", "turn"}}) {
      const Unit meant(ut_parse(read, unit, UT_UTF8));
      if (const Unit known(ut_parse(read, name, UT_UTF8)); meant && !known)
        ut_map_name_to_unit(name, UT_UTF8, meant.get());
    }
    return read;
  }();
  return system;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) > 127;
}

// UDUNITS-2 also reads "10 m", "m @ 5" and "m 3" as units. A number may stand here only as an exponent or as the
// "1" of "1/s", so that "72 mm 5" does not pass as 360 mm.
bool has_stray_number(std::string_view unit) {
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const char c = unit[i];
    const char before = i > 0 ? unit[i - 1] : ' ';
    const bool exponent = is_letter(before) || before == '^';
    if (c == '@' || (c == '-' && !exponent)) return true;
    if (!is_digit(c) || exponent || before == '-' || is_digit(before)) continue;
    const std::string_view rest = trimmed(unit.substr(i + 1));
    if (i > 0 || c != '1' || (!rest.empty() && rest.front() != '/')) return true;
  }
  return false;
}

// UDUNITS-2 reads to the first NUL, so that "A\0s/m" would pass as A.
bool has_control_character(std::string_view text) {
  return std::ranges::any_of(
      text, [](unsigned char c) { return (c < ' ' && c != '\t') || c == '\x7f'; });  // char has no sign on aarch64
}

// How units are usually written: for the right spelling of one that nobody knows.
constexpr std::array usual_units{"m",      "mm",    "um",    "nm",    "m/s",   "mm/s",  "m/min",   "mm/min",  "m/s^2",
                                 "mm/s^2", "m/s^3", "kg",    "g",     "N",     "kN",    "N m",     "N s/m",   "N/m",
                                 "N/um",   "N/A",   "N/V",   "N m/A", "V",     "A",     "mA",      "V/A",     "A/V",
                                 "Ohm",    "mOhm",  "H",     "mH",    "V s/m", "A s/m", "V s/rad", "1/s",     "s",
                                 "ms",     "us",    "ns",    "min",   "Hz",    "kHz",   "deg",     "rad",     "rev",
                                 "rpm",    "rad/s", "deg/s", "degC",  "K",     "W",     "kg m^2",  "N m/rad", "%"};

// "; did you mean ...?" for an unknown `unit`, of the dimension of the unit `wanted`; of any where that is empty.
std::string unit_suggestion(std::string_view unit, std::string_view wanted);

Unit parse_unit(std::string_view text, std::string_view wanted = {}) {
  const std::string unit(trimmed(text));
  if (has_control_character(unit)) throw UnitError("a control character in the unit");
  Unit parsed(has_stray_number(unit) ? nullptr : ut_parse(unit_system(), unit.c_str(), UT_UTF8));
  if (!parsed) throw UnitError(fmt::format("unknown unit \"{}\"{}", unit, unit_suggestion(unit, wanted)));
  return parsed;
}

std::string definition(const ut_unit* unit) {
  std::array<char, 256> buffer{};
  if (ut_format(unit, buffer.data(), buffer.size(), UT_ASCII | UT_DEFINITION) < 0) return "?";
  return buffer.data();
}

// From UDUNITS' "0.001 m.kg.s-2 @ 5" to "m kg s^-2".
std::string dimension_text(const ut_unit* unit) {
  std::string text = definition(unit);
  if (const std::size_t origin = text.find(" @"); origin != std::string::npos) text.erase(origin);
  if (is_digit(text.front()) || text.front() == '-') {
    const std::size_t blank = text.find(' ');
    text = blank == std::string::npos ? "1" : text.substr(blank + 1);
  }
  std::string readable;
  for (const char c : text) {
    const bool exponent = !readable.empty() && is_letter(readable.back()) && (is_digit(c) || c == '-');
    if (exponent) readable += '^';
    readable += c == '.' ? ' ' : c;
  }
  return readable;
}

// ut_are_convertible() is no test: it takes a reciprocal for convertible ("5 ms" for 1/s) and drops the radian.
bool same_dimension(const ut_unit* a, const ut_unit* b) {
  const Unit ratio(ut_divide(a, b));
  return ratio && ut_is_dimensionless(ratio.get()) != 0 && dimension_text(ratio.get()) == "1";
}

std::string unit_suggestion(std::string_view unit, std::string_view wanted) {
  std::vector<std::string_view> known;
  const Unit like(wanted.empty() ? nullptr : ut_parse(unit_system(), std::string(wanted).c_str(), UT_UTF8));
  for (const char* each : usual_units) {
    const Unit candidate(ut_parse(unit_system(), each, UT_UTF8));
    if (candidate && (!like || same_dimension(candidate.get(), like.get()))) known.emplace_back(each);
  }
  return did_you_mean(unit, known);
}

Converter converter(ut_unit* from, ut_unit* to) {
  Converter made(same_dimension(from, to) ? ut_get_converter(from, to) : nullptr);
  if (!made) throw UnitError(fmt::format("dimension {}, not {}", dimension_text(from), dimension_text(to)));
  return made;
}

double convert(const cv_converter* converter, double number) {
  if (cv_convert_double(converter, 0.0) != 0.0) return cv_convert_double(converter, number);
  return scaled(number, cv_convert_double(converter, 1.0));
}

// Of each thread, since a machine file has the same few units many times, and a sweep reads it for each of its rows:
// UDUNITS-2 takes ten times as long to read them as the rest of a file takes. Throws UnitError.
const cv_converter* kept_converter(std::string_view unit, std::string_view si_unit) {
  constexpr std::size_t most = 512;  // units that nobody writes twice must not fill the memory
  thread_local std::map<std::pair<std::string, std::string>, Converter> kept;
  const std::pair key{std::string(unit), std::string(si_unit)};
  if (const auto found = kept.find(key); found != kept.end()) return found->second.get();
  const std::lock_guard lock(library());
  const Unit from = parse_unit(unit, si_unit);
  const Unit to = parse_unit(si_unit);
  auto made = converter(from.get(), to.get());
  if (kept.size() >= most) kept.clear();
  return kept.emplace(key, std::move(made)).first->second.get();
}

}  // namespace

double parse_quantity(std::string_view text, std::string_view si_unit) {
  std::string_view unit;
  const double number = split_quantity(text, unit);
  if (unit.empty()) {
    if (si_unit != "1") throw UnitError("no unit");
    return number;
  }
  const double value = convert(kept_converter(unit, si_unit), number);
  if (!std::isfinite(value)) throw UnitError("beyond the range of numbers");
  return value;
}

std::string format_quantity(double value, std::string_view si_unit, std::string_view unit) {
  if (unit.empty() || unit == "1") return fmt::format("{}", value);
  const std::lock_guard lock(library());
  const Unit from = parse_unit(si_unit);
  const Unit to = parse_unit(unit);
  // 15 digits: what a double keeps of a decimal number.
  return fmt::format("{:.15g} {}", convert(converter(from.get(), to.get()).get(), value), unit);
}

std::string dimension_of(std::string_view unit) {
  const std::lock_guard lock(library());
  return dimension_text(parse_unit(unit).get());
}

}  // namespace stiction::machine
