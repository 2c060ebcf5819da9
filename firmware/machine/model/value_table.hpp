// What may stand in a table of the machine file whose law lives elsewhere (a friction model, an effect): its keys as
// data, and its values by key. So a reader of files needs no law to refuse a typo, a wrong unit or a value out of
// range.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "firmware/machine/model/parameter.hpp"

namespace stiction::machine {

// SI values by key; one value, or a list where the key takes one. A key that was left out and has no default is absent.
using KeyedValues = std::map<std::string, std::vector<double>, std::less<>>;

struct ValueKey {
  std::string_view key;                  // "viscous"
  std::string_view unit;                 // SI: "N s/m"; "1" for dimensionless
  std::string_view unit_of_force_motor;  // where it differs with a motor that is a force source; else empty
  Range range;                           // of each value
  bool list = false;
  bool optional = false;           // nothing when left out
  std::optional<double> fallback;  // when left out; none: the key is required, unless it is optional
  std::string_view text;
  std::string_view as_long_as;  // the key of a list that this one must be as long as; empty: any length
  bool rising = false;          // a list whose values increase strictly
};

struct ValueTable {
  std::string_view name;  // "force_ripple"
  std::string_view text;  // what it is, for the reference page
  bool several = false;   // whether one axis may have more than one of it
  std::vector<ValueKey> keys;
};

// Values that a table of the vocabulary cannot have, alone or on this axis.
class ValueError : public std::invalid_argument {
 public:
  // In the name of `table`; `what_found` and `what_expected` end the sentence "found ...; expected ...".
  ValueError(std::string_view table, std::string what_found, std::string what_expected)
      : std::invalid_argument(std::string(table) + ": found " + what_found + "; expected " + what_expected),
        name(table),
        found(std::move(what_found)),
        expected(std::move(what_expected)) {}

  std::string name;
  std::string found;
  std::string expected;
};

struct AxisModel;

// The tables that a machine file may hold beside those of machine.hpp. Whoever opens a file gives them.
struct Vocabulary {
  std::vector<ValueTable> friction_models;
  std::vector<ValueTable> effects;
  // Throws ValueError for effects whose values together, or beside the friction model in use, make no plant. Empty
  // where there is no plant, as in the drive.
  std::function<void(const AxisModel&)> check_effects;

  const ValueTable* find_effect(std::string_view name) const { return find(effects, name); }
  const ValueTable* find_friction_model(std::string_view name) const { return find(friction_models, name); }

 private:
  static const ValueTable* find(const std::vector<ValueTable>& tables, std::string_view name) {
    for (const ValueTable& table : tables)
      if (table.name == name) return &table;
    return nullptr;
  }
};

// Throws ValueError for a missing or unknown key, a value out of its range, a list where one value is wanted, and a
// list of another length or order than its key asks for.
void check_values(const ValueTable& table, const KeyedValues& values);

// What one typed parameter says.
template <class Owner>
ValueKey key_of(const Parameter<Owner>& p) {
  return {p.key,
          p.unit,
          p.unit_of_force_motor,
          p.range,
          std::holds_alternative<std::vector<double> Owner::*>(p.member),
          std::holds_alternative<std::optional<double> Owner::*>(p.member),
          p.fallback,
          p.text,
          p.as_long_as,
          p.rising};
}

// The keys of a table of typed parameters.
template <class Owner, std::size_t Count>
std::vector<ValueKey> keys_of(const std::array<Parameter<Owner>, Count>& parameters) {
  std::vector<ValueKey> keys;
  for (const auto& p : parameters) keys.push_back(key_of(p));
  return keys;
}

// Where the values of a typed parameter are in its owner. Whoever reads and writes values works on places, so that the
// compiler makes his code once and not once an owner.
using Place = std::variant<double*, int*, std::optional<double>*, std::vector<double>*>;
using ConstPlace = std::variant<const double*, const int*, const std::optional<double>*, const std::vector<double>*>;

template <class Owner, class MaybeConst>
auto place_of(const Parameter<Owner>& p, MaybeConst& owner) {
  using Found = std::conditional_t<std::is_const_v<MaybeConst>, ConstPlace, Place>;
  if (const auto* member = std::get_if<int Owner::*>(&p.member)) return Found(&(owner.**member));
  // What is larger than its owner is no member of it; without this gcc warns of writing beyond the owner.
  if constexpr (sizeof(std::optional<double>) <= sizeof(Owner))
    if (const auto* member = std::get_if<std::optional<double> Owner::*>(&p.member)) return Found(&(owner.**member));
  if constexpr (sizeof(std::vector<double>) <= sizeof(Owner))
    if (const auto* member = std::get_if<std::vector<double> Owner::*>(&p.member)) return Found(&(owner.**member));
  return Found(&(owner.*std::get<double Owner::*>(p.member)));
}

// The values there; none: an optional one that is not given.
std::vector<double> values_at(const ConstPlace& place);

// A list takes all of `values`, everything else the first one; without any the place keeps what it holds.
void put(const Place& place, const std::vector<double>& values);

// The values of `key` among `values`, or its default; none where both lack.
std::vector<double> given_or_default(const KeyedValues& values, const ValueKey& key);

// Typed parameters from values that were checked against their keys; what is absent keeps the default of its key, or
// else what `Owner` begins with.
template <class Owner, std::size_t Count>
Owner typed(const KeyedValues& values, const std::array<Parameter<Owner>, Count>& parameters) {
  Owner owner;
  for (const auto& p : parameters) put(place_of(p, owner), given_or_default(values, key_of(p)));
  return owner;
}

// Values by key from typed parameters.
template <class Owner, std::size_t Count>
KeyedValues keyed(const Owner& owner, const std::array<Parameter<Owner>, Count>& parameters) {
  KeyedValues values;
  for (const auto& p : parameters) {
    auto given = values_at(place_of(p, owner));
    if (!given.empty()) values[std::string(p.key)] = std::move(given);
  }
  return values;
}

}  // namespace stiction::machine
