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

#include "sim/machine/description.hpp"
#include "sim/machine/document.hpp"
#include "sim/machine/drive_parameters.hpp"
#include "sim/machine/parameters.hpp"
#include "sim/machine/units.hpp"
#include "sim/plant/effects/effects.hpp"

namespace stiction::sim {

class TableReader {
 public:
  // `force_motor`: quantities take their unit of a motor driven by voltage.
  TableReader(const Document& document, bool force_motor) : document_(document), force_motor_(force_motor) {}

  template <class Owner>
  Owner read(const toml::table& table, const std::string& path) const {
    using T = Table<Owner>;
    refuse_unknown<Owner>(table, path);
    Owner owner;
    for (const auto& p : T::texts) read_text(table, path, p, owner);
    std::apply([&](const auto&... p) { (read_choice(table, path, p, owner), ...); }, T::choices);
    read_parameters(table, path, T::parameters, owner);
    std::apply([&](const auto&... s) { (read_subtable(table, path, s, owner), ...); }, T::subtables);
    if constexpr (std::is_same_v<Owner, Friction>) read_friction_models(table, path, owner);
    if constexpr (std::is_same_v<Owner, Axis>) read_effects(table, path, owner);
    return owner;
  }

  const toml::table& as_table(const toml::node& node, const std::string& path, std::string_view text) const {
    if (!node.is_table()) document_.fail(node.source(), path, describe_node(node), fmt::format("a table ({})", text));
    return *node.as_table();
  }

 private:
  template <class Owner>
  static std::vector<std::string_view> known_keys() {
    using T = Table<Owner>;
    std::vector<std::string_view> known;
    if constexpr (std::is_same_v<Owner, Machine>) known.push_back("schema");
    for (const auto& p : T::texts) known.push_back(p.key);
    std::apply([&](const auto&... p) { (known.push_back(p.key), ...); }, T::choices);
    for (const auto& p : T::parameters) known.push_back(p.key);
    std::apply([&](const auto&... s) { (known.push_back(s.key), ...); }, T::subtables);
    if constexpr (std::is_same_v<Owner, Friction>)
      for_each_friction_model([&]<class Model>() { known.push_back(Model::name); });
    if constexpr (std::is_same_v<Owner, Axis>) known.push_back(effect_key);
    if constexpr (std::is_same_v<Owner, Machine>)
      known.insert(known.end(), {"axis", "drive", "experiment", "reference"});
    if constexpr (std::is_same_v<Owner, DriveSetup>) known.push_back("axis");
    return known;
  }

  template <class Owner>
  void refuse_unknown(const toml::table& table, const std::string& path) const {
    refuse_unknown(table, path, known_keys<Owner>());
  }

  void refuse_unknown(const toml::table& table, const std::string& path,
                      const std::vector<std::string_view>& known) const {
    for (auto&& [key, value] : table)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        document_.fail_unknown(key.source(), join_key(path, key.str()), known);
  }

  template <class Owner>
  void read_text(const toml::table& table, const std::string& path, const TextParameter<Owner>& p, Owner& owner) const {
    const std::string key = join_key(path, p.key);
    const std::string expected = fmt::format("a text ({})", p.text);
    const toml::node* node = table.get(p.key);
    const bool required = std::holds_alternative<std::string Owner::*>(p.member);
    if (node == nullptr && !required) return;
    if (node == nullptr) document_.fail(table.source(), key, "no such key", expected);
    const auto* text = node->as_string();
    if (text == nullptr || text->get().empty()) document_.fail(node->source(), key, describe_node(*node), expected);
    std::visit([&](auto member) { owner.*member = text->get(); }, p.member);
  }

  template <class Owner, class Value>
  void read_choice(const toml::table& table, const std::string& path, const ChoiceParameter<Owner, Value>& p,
                   Owner& owner) const {
    const toml::node* node = table.get(p.key);
    if (node == nullptr && p.fallback) {
      owner.*p.member = *p.fallback;
      return;
    }
    std::vector<std::string_view> names;
    for (const Choice<Value>& choice : p.choices) {
      names.push_back(choice.name);
      if (node == nullptr || !node->is_string() || node->as_string()->get() != choice.name) continue;
      owner.*p.member = choice.value;
      return;
    }
    document_.fail(node == nullptr ? table.source() : node->source(), join_key(path, p.key),
                   node == nullptr ? "no such key" : describe_node(*node),
                   fmt::format("{} ({})", quoted_list(names), p.text));
  }

  template <class Owner, std::size_t Count>
  void read_parameters(const toml::table& table, const std::string& path,
                       const std::array<Parameter<Owner>, Count>& parameters, Owner& owner) const {
    for (const Parameter<Owner>& p : parameters)
      std::visit(
          [&]<class Member>(Member Owner::*member) {
            // What is larger than its owner is no member of it; without this gcc warns of reading beyond the owner.
            if constexpr (sizeof(Member) <= sizeof(Owner)) read_parameter(table, path, p, owner.*member);
          },
          p.member);
  }

  template <class Owner, class Member>
  void read_parameter(const toml::table& table, const std::string& path, const Parameter<Owner>& p,
                      Member& member) const {
    const std::string_view unit = force_motor_ && !p.unit_of_force_motor.empty() ? p.unit_of_force_motor : p.unit;
    const Wanted wanted{join_key(path, p.key), unit, p.range, p.text};
    if (const toml::node* node = table.get(p.key)) {
      read_value(*node, wanted, member);
    } else if constexpr (std::is_arithmetic_v<Member>) {
      if (!p.fallback)
        fail_missing(table, wanted, std::is_same_v<Member, int> ? ValueKind::whole_number : ValueKind::number);
      member = static_cast<Member>(*p.fallback);
    } else if constexpr (std::is_same_v<Member, std::vector<double>>) {
      fail_missing(table, wanted, ValueKind::list);
    }
  }

  // Far beyond what any machine has; but the plant divides by these numbers and multiplies them, and a mass of 1e-323
  // kg has no finite reciprocal.
  static constexpr double least_magnitude = 1e-30, largest_magnitude = 1e30;

  // One value to read: its key and what it must be.
  struct Wanted {
    std::string key;
    std::string_view unit;
    Range range;
    std::string_view text;
    std::string expected(ValueKind kind) const { return describe_expectation(kind, range, unit, text); }
  };

  [[noreturn]] void fail_missing(const toml::table& table, const Wanted& wanted, ValueKind kind) const {
    document_.fail(table.source(), wanted.key, "no such key", wanted.expected(kind));
  }
  [[noreturn]] void fail_value(const toml::node& node, const Wanted& wanted, ValueKind kind,
                               std::string_view why = {}) const {
    const std::string reason = why.empty() ? "" : fmt::format(" ({})", why);
    document_.fail(node.source(), wanted.key, describe_node(node) + reason, wanted.expected(kind));
  }

  double quantity(const toml::node& node, const Wanted& wanted) const {
    try {
      if (const auto* text = node.as_string()) return parse_quantity(text->get(), wanted.unit);
    } catch (const UnitError& error) {
      fail_value(node, wanted, ValueKind::number, error.what());
    }
    if (!node.is_number()) fail_value(node, wanted, ValueKind::number);
    if (wanted.unit != "1") fail_value(node, wanted, ValueKind::number, "no unit");
    return *node.value<double>();
  }

  void read_value(const toml::node& node, const Wanted& wanted, double& value) const {
    value = quantity(node, wanted);
    if (!std::isfinite(value) || !wanted.range.contains(value)) fail_value(node, wanted, ValueKind::number);
    if (value != 0.0 && !(std::abs(value) >= least_magnitude && std::abs(value) <= largest_magnitude))
      fail_value(node, wanted, ValueKind::number, "beyond all machines: 1e-30 to 1e30 in SI units");
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
      const Wanted one{fmt::format("{}[{}]", wanted.key, values.size()), wanted.unit, wanted.range, wanted.text};
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
      if (node != nullptr) owner.*s.member = read<Inner>(as_table(*node, key, Table<Inner>::text), key);
    } else if (node != nullptr || s.presence == Presence::optional) {
      static const toml::table absent;
      owner.*s.member = read<Member>(node == nullptr ? absent : as_table(*node, key, Table<Member>::text), key);
    } else {
      document_.fail(table.source(), key, "no such table", fmt::format("[{}] ({})", key, Table<Member>::text));
    }
  }

  void read_friction_models(const toml::table& table, const std::string& path, Friction& friction) const {
    for_each_friction_model([&]<class Model>() {
      const toml::node* node = table.get(Model::name);
      if (node == nullptr) return;
      const std::string key = join_key(path, Model::name);
      const toml::table& model = as_table(*node, key, Model::label);
      std::vector<std::string_view> known;
      for (const auto& p : Model::parameters) known.push_back(p.key);
      refuse_unknown(model, key, known);
      typename Model::Parameters parameters;
      read_parameters(model, key, Model::parameters, parameters);
      friction.models.emplace(Model::name, parameters);
    });
  }

  void read_effects(const toml::table& table, const std::string& path, Axis& axis) const {
    const toml::node* node = table.get(effect_key);
    if (node == nullptr) return;
    const std::string key = join_key(path, effect_key);
    if (!node->is_array()) document_.fail(node->source(), key, describe_node(*node), fmt::format("tables [[{}]]", key));
    for (const toml::node& element : *node->as_array()) {
      const std::string element_path = fmt::format("{}[{}]", key, axis.effects.size());
      axis.effects.push_back(read_effect(as_table(element, element_path, "an effect"), element_path));
    }
  }

  Effect read_effect(const toml::table& table, const std::string& path) const {
    Effect named;
    read_text(table, path, TextParameter<Effect>{effect_name_key, &Effect::name, "name of the effect"}, named);
    const std::string& name = named.name;
    std::optional<Effect> effect;
    std::vector<std::string_view> names;
    for_each_effect([&]<class E>() {
      names.push_back(E::name);
      if (E::name == name) effect = read_values<E>(table, path);
    });
    if (effect) return *effect;
    const std::string_view nearest = nearest_name(name, names);
    document_.fail(table.get(effect_name_key)->source(), join_key(path, effect_name_key), fmt::format("\"{}\"", name),
                   fmt::format("an effect: {}{}", quoted_list(names),
                               nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
  }

  template <class E>
  Effect read_values(const toml::table& table, const std::string& path) const {
    std::vector<std::string_view> known{effect_name_key};
    for (const auto& p : E::parameters) known.push_back(p.key);
    refuse_unknown(table, path, known);
    if (table.size() == 1)
      document_.fail(table.source(), path, "no key but its name",
                     fmt::format("{} with its values: {}", E::name, fmt::join(known.begin() + 1, known.end(), ", ")));
    typename E::Parameters parameters;
    read_parameters(table, path, E::parameters, parameters);
    return effect_of<E>(parameters);
  }

  const Document& document_;
  bool force_motor_;
};

}  // namespace stiction::sim
