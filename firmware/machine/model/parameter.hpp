// The one description of a parameter: key, unit, range, default, text. The machine file's reader and its checks, the
// log header and the generated reference are made from it, so a parameter cannot exist in one of them only.
#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace stiction::machine {

// Allowed values in SI units; `low_open` excludes the lower end itself ("positive" instead of "not negative").
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;

  constexpr bool contains(double value) const { return (low_open ? value > low : value >= low) && value <= high; }
};

constexpr Range any_value() { return {}; }
constexpr Range positive(double high = std::numeric_limits<double>::infinity()) { return {0.0, high, true}; }
constexpr Range not_negative(double high = std::numeric_limits<double>::infinity()) { return {0.0, high, false}; }

template <class Owner>
struct Parameter {
  // An optional member is left empty when the key is absent; a vector holds a list of quantities.
  using Member =
      std::variant<double Owner::*, int Owner::*, std::optional<double> Owner::*, std::vector<double> Owner::*>;

  std::string_view key;
  std::string_view unit;  // SI, in the spelling of UDUNITS-2; "1" for dimensionless
  Range range;
  Member member;
  std::optional<double> fallback;  // the default; none: the key is required, unless the member is itself optional
  std::string_view text;
  std::string_view unit_of_force_motor = {};  // the unit where the motor is a force source driven by voltage
  std::string_view as_long_as = {};           // the key of a list that this list must be as long as; empty: any length
  bool rising = false;                        // a list whose values increase strictly
};

}  // namespace stiction::machine
