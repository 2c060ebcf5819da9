// Fills the structs of machine.hpp from TOML tables by walking the descriptions of parameters.hpp; no key is named
// here except through them. Private to the reader of machine files.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/drive_parameters.hpp"
#include "firmware/machine/file/exact_value.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/parameters.hpp"
#include "firmware/machine/file/units.hpp"
#include "firmware/machine/model/own_words.hpp"
#include "firmware/machine/model/value_table.hpp"

namespace stiction::machine {

// Whose units an axis' values have: its own, and those of its motor's table.
struct AxisCoordinates {
  Coordinate axis{}, motor{};
  bool controller_in_volts = false;  // the unit of [controller] gain
};

class TableReader {
 public:
  // `force_motor`: quantities take their unit of a motor driven by voltage. `vocabulary`: of friction models and
  // effects, for whoever reads an axis. `coordinates`: of the axis that is read. `document`: names the place in
  // messages.
  TableReader(const Document& document, bool force_motor, const Vocabulary* vocabulary = nullptr,
              const AxisCoordinates& coordinates = {})
      : document_(document),
        force_motor_(force_motor),
        vocabulary_(vocabulary),
        coordinates_(coordinates),
        coordinate_(coordinates.axis) {}

  template <class Owner>
  Owner read(const toml::table& table, const std::string& path) const {
    using T = Table<Owner>;
    refuse_unknown(table, path, known_keys<Owner>());
    Owner owner;
    const auto attempt = [&](auto&& read_one) { document_.attempt(read_one); };
    for (const auto& p : T::texts) attempt([&] { read_text(table, path, p, owner); });
    std::apply([&](const auto&... p) { (attempt([&] { read_choice(table, path, p, owner); }), ...); }, T::choices);
    read_parameters(table, path, T::parameters, owner);
    std::apply([&](const auto&... s) { (attempt([&] { read_subtable(table, path, s, owner); }), ...); }, T::subtables);
    if constexpr (std::is_base_of_v<FrictionParameters, Owner>) read_friction_models(table, path, owner);
    if constexpr (std::is_same_v<Owner, AxisModel>) read_effects(table, path, owner);
    return owner;
  }

  // The `node` at `path` as a table; `text` says what it should hold. Throws MachineFileError.
  const toml::table& as_table(const toml::node& node, const std::string& path, std::string_view text) const {
    if (!node.is_table()) document_.fail(node.source(), path, describe_node(node), fmt::format("a table ({})", text));
    return *node.as_table();
  }

 private:
  template <class Owner>
  std::vector<std::string_view> known_keys() const {
    using T = Table<Owner>;
    std::vector<std::string_view> known;
    if constexpr (std::is_same_v<Owner, Machine>) known.push_back("schema");
    for (const auto& p : T::texts) known.push_back(p.key);
    std::apply([&](const auto&... p) { (known.push_back(p.key), ...); }, T::choices);
    for (const auto& p : T::parameters) known.push_back(coordinate_.own(p.key, p.unit).key);
    std::apply([&](const auto&... s) { (known.push_back(s.key), ...); }, T::subtables);
    if constexpr (std::is_base_of_v<FrictionParameters, Owner>)
      for (const ValueTable& model : vocabulary_->friction_models) known.push_back(model.name);
    if constexpr (std::is_same_v<Owner, AxisModel>) known.push_back(effect_key);
    if constexpr (std::is_same_v<Owner, Machine>)
      known.insert(known.end(), {"axis", "drive", "expected", "experiment", "reference"});
    if constexpr (std::is_same_v<Owner, DriveSetup>) known.push_back("axis");
    return known;
  }

  void refuse_unknown(const toml::table& table, const std::string& path,
                      const std::vector<std::string_view>& known) const {
    for (auto&& [key, value] : table)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        document_.attempt(
            [&, &name = key] { document_.fail_unknown(name.source(), join_key(path, name.str()), known); });
  }

  template <class Owner>
  void read_text(const toml::table& table, const std::string& path, const TextParameter<Owner>& p, Owner& owner) const {
    const auto* required = std::get_if<std::string Owner::*>(&p.member);
    const auto* text = text_of(table, path, p.key, p.text, required != nullptr);
    if (text == nullptr) return;
    if (required != nullptr)
      owner.** required = *text;
    else
      owner.*std::get<std::optional<std::string> Owner::*>(p.member) = *text;
  }

  // Null for what is left out and not required.
  const std::string* text_of(const toml::table& table, const std::string& path, std::string_view name,
                             std::string_view what, bool required) const {
    const std::string key = join_key(path, name);
    const std::string expected = fmt::format("a text ({})", what);
    const toml::node* node = table.get(name);
    if (node == nullptr && !required) return nullptr;
    if (node == nullptr) document_.fail(table.source(), key, "no such key", expected);
    const auto* text = node->as_string();
    if (text == nullptr || text->get().empty()) document_.fail(node->source(), key, describe_node(*node), expected);
    return &text->get();
  }

  template <class Owner, class Value>
  void read_choice(const toml::table& table, const std::string& path, const ChoiceParameter<Owner, Value>& p,
                   Owner& owner) const {
    std::vector<std::string_view> names;
    for (const Choice<Value>& choice : p.choices) names.push_back(choice.name);
    const auto chosen = choice_of(table, path, p.key, p.text, names, p.fallback.has_value());
    owner.*p.member = chosen ? p.choices[*chosen].value : *p.fallback;
  }

  // Which of `names`; none where the key is absent and has a default.
  std::optional<std::size_t> choice_of(const toml::table& table, const std::string& path, std::string_view key,
                                       std::string_view text, const std::vector<std::string_view>& names,
                                       bool has_default) const {
    const toml::node* node = table.get(key);
    if (node == nullptr && has_default) return std::nullopt;
    const auto* given = node == nullptr ? nullptr : node->as_string();
    if (given != nullptr)
      for (std::size_t k = 0; k < names.size(); ++k)
        if (given->get() == names[k]) return k;
    document_.fail(
        node == nullptr ? table.source() : node->source(), join_key(path, key),
        node == nullptr ? "no such key" : describe_node(*node),
        fmt::format("{} ({}){}", quoted_list(names), text, given != nullptr ? did_you_mean(given->get(), names) : ""));
  }

  template <class Owner, std::size_t Count>
  void read_parameters(const toml::table& table, const std::string& path,
                       const std::array<Parameter<Owner>, Count>& parameters, Owner& owner) const {
    for (const Parameter<Owner>& p : parameters)
      document_.attempt([&] { read_parameter(table, path, key_of(p), place_of(p, owner)); });
  }

  void read_parameter(const toml::table& table, const std::string& path, const ValueKey& key,
                      const Place& place) const {
    const auto unit = unit_of_key(key);
    const OwnQuantity own = coordinate_.own(key.key, unit);
    const Wanted wanted{join_key(path, own.key), own, key.range, in_own_words(key.text, coordinate_)};
    const toml::node* node = table.get(own.key);
    if (node != nullptr)
      std::visit([&](auto* member) { read_value(*node, wanted, *member); }, place);
    else if (!key.optional && !key.fallback)
      fail_missing(table, wanted, kind_of(key, place));
    else if (key.fallback)
      put(place, {own.to_linear(*key.fallback)});
  }

  static ValueKind kind_of(const ValueKey& key, const Place& place) {
    if (key.list) return ValueKind::list;
    return std::holds_alternative<int*>(place) ? ValueKind::whole_number : ValueKind::number;
  }

  // Far beyond what any machine has; but the plant divides by these numbers and multiplies them, and a mass of 1e-323
  // kg has no finite reciprocal.
  static constexpr double least_magnitude = 1e-30, largest_magnitude = 1e30;

  // One value to read: its key and what it must be. The range is that of the number in the file.
  struct Wanted {
    std::string key;
    OwnQuantity own;
    Range range;
    std::string text;
    std::string expected(ValueKind kind) const { return describe_expectation(kind, range, own.unit, text); }
  };
  std::string_view unit_of_key(const ValueKey& key) const {
    return force_motor_ && !key.unit_of_force_motor.empty() ? key.unit_of_force_motor : key.unit;
  }
  // Of the vocabulary, whose keys every kind of axis has.
  Wanted wanted_of(const std::string& path, const ValueKey& key) const {
    return {join_key(path, key.key), coordinate_.own(unit_of_key(key)), key.range, in_own_words(key.text, coordinate_)};
  }

  [[noreturn]] void fail_missing(const toml::table& table, const Wanted& wanted, ValueKind kind) const {
    document_.fail(table.source(), wanted.key, "no such key", wanted.expected(kind));
  }
  [[noreturn]] void fail_value(const toml::node& node, const Wanted& wanted, ValueKind kind,
                               std::string_view why = {}) const {
    const std::string reason = why.empty() ? "" : fmt::format(" ({})", why);
    document_.fail(node.source(), wanted.key, describe_node(node) + reason, wanted.expected(kind));
  }

  // The value of "355/113"; none for any other text ("3 mm/mm"). Both its numbers are doubles: it is rounded once.
  static std::optional<double> fraction_of(std::string_view text) {
    if (text.find('/') == std::string_view::npos || text.find_first_not_of("0123456789/") != std::string_view::npos)
      return std::nullopt;
    const auto value = exact_number(text);
    if (!value) throw UnitError(fmt::format("no fraction of two whole numbers from 1 to {}", largest_in_file_words));
    return static_cast<double>(value->numerator) / static_cast<double>(value->denominator);
  }

  double quantity(const toml::node& node, const Wanted& wanted) const {
    try {
      const auto* text = node.as_string();
      if (const auto fraction = text != nullptr && wanted.own.unit == "1" ? fraction_of(text->get()) : std::nullopt)
        return *fraction;
      if (text != nullptr) return parse_quantity(text->get(), wanted.own.unit);
    } catch (const UnitError& error) {
      fail_value(node, wanted, ValueKind::number, error.what());
    }
    if (!node.is_number()) fail_value(node, wanted, ValueKind::number);
    if (wanted.own.unit != "1") fail_value(node, wanted, ValueKind::number, "no unit");
    return *node.value<double>();
  }

  void read_value(const toml::node& node, const Wanted& wanted, double& value) const {
    value = quantity(node, wanted);
    if (!std::isfinite(value) || !wanted.range.contains(value)) fail_value(node, wanted, ValueKind::number);
    if (value != 0.0 && !(std::abs(value) >= least_magnitude && std::abs(value) <= largest_magnitude))
      fail_value(node, wanted, ValueKind::number, "beyond all machines: 1e-30 to 1e30 in SI units");
    value = wanted.own.to_linear(value);
  }
  void read_value(const toml::node& node, const Wanted& wanted, std::optional<double>& value) const {
    read_value(node, wanted, value.emplace());
  }
  void read_value(const toml::node& node, const Wanted& wanted, int& value) const {
    const auto* number = node.as_integer();
    if (number == nullptr || !std::in_range<int>(number->get()) ||
        !wanted.range.contains(static_cast<double>(number->get())))
      fail_value(node, wanted, ValueKind::whole_number);
    value = static_cast<int>(number->get());
  }
  void read_value(const toml::node& node, const Wanted& wanted, std::vector<double>& values) const {
    const auto* list = node.as_array();
    if (list == nullptr || list->empty()) fail_value(node, wanted, ValueKind::list, list == nullptr ? "" : "empty");
    for (const toml::node& element : *list) {
      const Wanted one{fmt::format("{}[{}]", wanted.key, values.size()), wanted.own, wanted.range, wanted.text};
      read_value(element, one, values.emplace_back());
    }
  }

  template <class Owner, class Member>
  void read_subtable(const toml::table& table, const std::string& path, const Subtable<Owner, Member>& s,
                     Owner& owner) const {
    const std::string key = join_key(path, s.key);
    const toml::node* node = table.get(s.key);
    if constexpr (requires(Member m) { m.emplace(); }) {
      using Inner = typename Member::value_type;
      if (node != nullptr)
        owner.*s.member = inside<Inner>().template read<Inner>(as_table(*node, key, Table<Inner>::text), key);
    } else if (node != nullptr || s.presence == Presence::optional) {
      static const toml::table absent;
      owner.*s.member = inside<Member>().template read<Member>(
          node == nullptr ? absent : as_table(*node, key, Table<Member>::text), key);
    } else if (s.presence == Presence::required) {
      document_.fail(table.source(), key, "no such table", fmt::format("[{}] ({})", key, Table<Member>::text));
    }
  }

  // The reader of a table within that of an axis.
  template <class Inner>
  TableReader inside() const {
    TableReader reader = *this;
    if constexpr (std::is_same_v<Inner, MotorParameters> || std::is_same_v<Inner, MotorFriction>)
      reader.coordinate_ = coordinates_.motor;
    if constexpr (std::is_same_v<Inner, ControllerParameters>) reader.force_motor_ = coordinates_.controller_in_volts;
    return reader;
  }

  void read_friction_models(const toml::table& table, const std::string& path, FrictionParameters& friction) const {
    for (const ValueTable& model : vocabulary_->friction_models)
      if (const toml::node* node = table.get(model.name)) {
        const std::string key = join_key(path, model.name);
        document_.attempt(
            [&] { friction.models.emplace(model.name, read_values(as_table(*node, key, model.text), key, model)); });
      }
  }

  void read_effects(const toml::table& table, const std::string& path, AxisModel& axis) const {
    const toml::node* node = table.get(effect_key);
    if (node == nullptr) return;
    const std::string key = join_key(path, effect_key);
    if (!node->is_array()) document_.fail(node->source(), key, describe_node(*node), fmt::format("tables [[{}]]", key));
    for (const toml::node& element : *node->as_array()) {
      const std::string element_path = fmt::format("{}[{}]", key, axis.effects.size());
      axis.effects.emplace_back();
      document_.attempt(
          [&] { axis.effects.back() = read_effect(as_table(element, element_path, "an effect"), element_path); });
    }
  }

  Effect read_effect(const toml::table& table, const std::string& path) const {
    Effect named;
    read_text(table, path, TextParameter<Effect>{effect_name_key, &Effect::name, "name of the effect"}, named);
    const std::string& name = named.name;
    const ValueTable* known = vocabulary_->find_effect(name);
    if (known == nullptr) fail_unknown_effect(table, path, name);
    if (table.size() == 1) {
      std::vector<std::string_view> keys;
      for (const ValueKey& key : known->keys) keys.push_back(key.key);
      document_.fail(table.source(), path, "no key but its name",
                     fmt::format("{} with its values: {}", name, fmt::join(keys, ", ")));
    }
    named.values = read_values(table, path, *known, effect_name_key);
    return named;
  }

  [[noreturn]] void fail_unknown_effect(const toml::table& table, const std::string& path,
                                        const std::string& name) const {
    std::vector<std::string_view> names;
    for (const ValueTable& effect : vocabulary_->effects) names.push_back(effect.name);
    document_.fail(table.get(effect_name_key)->source(), join_key(path, effect_name_key), fmt::format("\"{}\"", name),
                   fmt::format("an effect: {}{}", quoted_list(names), did_you_mean(name, names)));
  }

  // The values of a table that the vocabulary describes; `besides` is a key of it that is no value.
  KeyedValues read_values(const toml::table& table, const std::string& path, const ValueTable& description,
                          std::string_view besides = {}) const {
    std::vector<std::string_view> known;
    if (!besides.empty()) known.push_back(besides);
    for (const ValueKey& key : description.keys) known.push_back(key.key);
    refuse_unknown(table, path, known);
    KeyedValues values;
    for (const ValueKey& key : description.keys)
      document_.attempt([&] {
        const auto read = read_value_of(table, path, key);
        if (!read.empty()) values.emplace(key.key, read);
      });
    for (const ValueKey& key : description.keys) check_list(table, path, key, values);
    return values;
  }

  // Empty for what is left out and has no default.
  std::vector<double> read_value_of(const toml::table& table, const std::string& path, const ValueKey& key) const {
    const Wanted wanted = wanted_of(path, key);
    const toml::node* node = table.get(key.key);
    if (node == nullptr) {
      if (key.fallback) return {wanted.own.to_linear(*key.fallback)};
      if (!key.optional) fail_missing(table, wanted, key.list ? ValueKind::list : ValueKind::number);
      return {};
    }
    std::vector<double> values;
    if (key.list)
      read_value(*node, wanted, values);
    else
      read_value(*node, wanted, values.emplace_back());
    return values;
  }

  void check_list(const toml::table& table, const std::string& path, const ValueKey& key,
                  const KeyedValues& values) const {
    const auto found = values.find(key.key);
    if (found == values.end()) return;
    const auto& list = found->second;
    const auto place = [&] { return table.get(key.key)->source(); };
    if (!key.as_long_as.empty()) {
      const auto other = values.find(key.as_long_as);
      const std::size_t wanted = other == values.end() ? 0 : other->second.size();
      if (list.size() != wanted)
        document_.fail(place(), join_key(path, key.key), fmt::format("a list of {}", list.size()),
                       fmt::format("a list of {}, as many as {} has", wanted, key.as_long_as));
    }
    if (!key.rising) return;
    const OwnQuantity own = coordinate_.own(key.unit);
    for (std::size_t k = 1; k < list.size(); ++k)
      if (list[k] <= list[k - 1])
        document_.fail(place(), fmt::format("{}[{}]", join_key(path, key.key), k),
                       fmt::format("{:g}", own.from_linear(list[k])),
                       fmt::format("a value above the one before it, {:g} {}", own.from_linear(list[k - 1]), own.unit));
  }

  const Document& document_;
  bool force_motor_;
  const Vocabulary* vocabulary_;
  AxisCoordinates coordinates_;
  Coordinate coordinate_;  // of the table that is read
};

}  // namespace stiction::machine
