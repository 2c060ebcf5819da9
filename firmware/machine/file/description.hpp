// All keys of a machine file as plain text, made from the tables of parameters.hpp: for the reference page, and for
// the reader's messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/parameter.hpp"
#include "firmware/machine/model/value_table.hpp"

namespace stiction::machine {

struct KeyDescription {
  std::string key;
  std::string unit;                 // SI; "1" for a number, empty for a text or a name
  std::string unit_of_force_motor;  // where it differs
  std::string allowed;              // "greater than 0 kg", or the names to choose from; empty: any
  std::string fallback;             // "required", "left out" (the text says what that means), or the default
  std::string text;
  std::string expected;           // the sentence of an error message: "a value greater than 0 kg (moving mass)"
  std::string rotary_expected{};  // the same of a rotary axis or motor
  bool list = false;
};

struct TableDescription {
  std::string name;      // "axis.NAME.motor"
  std::string presence;  // "required", "optional", "required with model = ..."
  std::string text;
  std::vector<KeyDescription> keys;
};

// Every table of the format, in the order of the reference page; friction models and effects as `vocabulary` has them.
std::vector<TableDescription> machine_file_description(const Vocabulary& vocabulary);

// "greater than 0 kg", "from 1 to 10"; empty for any value.
std::string describe_range(const Range& range, std::string_view unit);

enum class ValueKind { number, whole_number, list };

// What a value must be: "a value greater than 0 kg (moving mass)". `kind` of value, its `range` in `unit`, and `text`,
// what it is.
std::string describe_expectation(ValueKind kind, const Range& range, std::string_view unit, std::string_view text);

// Names as a message lists them: `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string_view>& names);

}  // namespace stiction::machine
