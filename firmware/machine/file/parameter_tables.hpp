// How the keys of a machine file are described: texts, choices, subtables, and the table that collects them. The tables
// themselves are in parameters.hpp and feed_drive_parameters.hpp.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>

#include "firmware/machine/model/parameter.hpp"

namespace stiction::machine {

// A key whose value is a text; required unless the member is optional.
template <class Owner>
struct TextParameter {
  std::string_view key;
  std::variant<std::string Owner::*, std::optional<std::string> Owner::*> member;
  std::string_view text;
};

// A key whose value is one of several names.
template <class Value>
struct Choice {
  std::string_view name;
  Value value;
  std::string_view text;
};
template <class Owner, class Value>
struct ChoiceParameter {
  std::string_view key;
  Value Owner::*member;
  std::span<const Choice<Value>> choices;
  std::optional<Value> fallback;  // none: the key is required
  std::string_view text;
};

// A table within a table; Member may be std::optional.
enum class Presence { required, optional, by_motor_model, by_structure };
template <class Owner, class Member>
struct Subtable {
  std::string_view key;
  Member Owner::*member;
  Presence presence;
};

// What a table of the file holds; specialised for each struct of machine.hpp.
template <class Owner>
struct Table;

template <class Owner>
struct EmptyTable {
  static constexpr std::array<TextParameter<Owner>, 0> texts{};
  static constexpr std::tuple<> choices{};
  static constexpr std::array<Parameter<Owner>, 0> parameters{};
  static constexpr std::tuple<> subtables{};
};

}  // namespace stiction::machine
