#include "firmware/machine/file/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/file/drive_parameters.hpp"
#include "firmware/machine/file/expected_parameters.hpp"
#include "firmware/machine/file/parameters.hpp"
#include "firmware/machine/model/own_words.hpp"

namespace stiction::machine {
namespace {

std::string with_unit(double value, std::string_view unit) {
  return unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

// The motor models that need `path` (a key from the axis on).
std::vector<std::string_view> motor_models_that_need(std::string_view path) {
  std::vector<std::string_view> names;
  for (const MotorRule& rule : motor_rules)
    if (std::find(rule.needs.begin(), rule.needs.end(), path) != rule.needs.end())
      for (const auto& choice : motor_models)
        if (choice.value == rule.model) names.push_back(choice.name);
  return names;
}

std::string need_of(std::string_view path) {
  for (const Alternatives& pair : alternatives)
    if (path == pair.first) return fmt::format("required without {}", pair.second.substr(pair.second.rfind('.') + 1));
  const auto models = motor_models_that_need(path);
  return models.empty() ? std::string{} : fmt::format("required with motor model {}", quoted_list(models));
}

KeyDescription describe(const ValueKey& p, ValueKind kind, const std::string& need = {}) {
  KeyDescription key;
  key.key = p.key;
  key.unit = p.unit;
  key.unit_of_force_motor = p.unit_of_force_motor;
  key.allowed = describe_range(p.range, p.unit);
  key.text = p.text;
  key.expected = describe_expectation(kind, p.range, p.unit, p.text);
  key.list = kind == ValueKind::list;
  constexpr Coordinate rotary{AxisKind::rotary, 1.0};
  key.rotary_expected =
      describe_expectation(kind, p.range, rotary.own(p.key, p.unit).unit, in_own_words(p.text, rotary));
  if (!need.empty())
    key.fallback = need;
  else if (p.optional)
    key.fallback = "left out";
  else if (!p.fallback)
    key.fallback = "required";
  else
    key.fallback = std::isfinite(*p.fallback) ? with_unit(*p.fallback, p.unit) : "none";
  return key;
}

template <class Owner>
KeyDescription describe(const Parameter<Owner>& p, std::string_view path) {
  const ValueKey key = key_of(p);
  const bool whole = std::holds_alternative<int Owner::*>(p.member);
  return describe(key, key.list ? ValueKind::list : whole ? ValueKind::whole_number : ValueKind::number, need_of(path));
}

struct NamedChoice {
  std::string_view name, text;
};

KeyDescription describe_choice(std::string_view name, std::string_view text, const std::vector<NamedChoice>& choices,
                               std::optional<std::size_t> fallback) {
  KeyDescription key;
  key.key = name;
  key.fallback = fallback ? fmt::format("\"{}\"", choices[*fallback].name) : "required";
  key.text = text;
  std::vector<std::string_view> names;
  for (const auto& choice : choices) {
    names.push_back(choice.name);
    key.allowed += fmt::format("{}\"{}\": {}", key.allowed.empty() ? "" : "; ", choice.name, choice.text);
  }
  key.expected = fmt::format("{} ({})", quoted_list(names), text);
  return key;
}

template <class Owner, class Value>
KeyDescription describe(const ChoiceParameter<Owner, Value>& p) {
  std::vector<NamedChoice> choices;
  std::optional<std::size_t> fallback;
  for (const Choice<Value>& choice : p.choices) {
    if (p.fallback == choice.value) fallback = choices.size();
    choices.push_back({choice.name, choice.text});
  }
  return describe_choice(p.key, p.text, choices, fallback);
}

KeyDescription describe_text(std::string_view key, std::string_view text, bool required) {
  return {.key = std::string(key),
          .unit = {},
          .unit_of_force_motor = {},
          .allowed = "a text",
          .fallback = required ? "required" : "left out",
          .text = std::string(text),
          .expected = fmt::format("a text ({})", text)};
}

template <class Owner>
KeyDescription describe(const TextParameter<Owner>& p) {
  return describe_text(p.key, p.text, std::holds_alternative<std::string Owner::*>(p.member));
}

template <class T>
struct Unwrapped {
  using type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using type = T;
};

// Keys of the axis' own tables are looked up in motor_rules by their path from the axis on.
constexpr std::string_view axis_prefix = "axis.NAME.";

std::string path_in_axis(std::string_view table, std::string_view key) {
  if (!table.starts_with(axis_prefix)) return {};
  return fmt::format("{}.{}", table.substr(axis_prefix.size()), key);
}

template <class Owner>
void describe_table(const std::string& name, const std::string& presence, std::vector<TableDescription>& out) {
  using T = Table<Owner>;
  TableDescription table{name, presence, std::string(T::text), {}};
  for (const auto& p : T::texts) table.keys.push_back(describe(p));
  std::apply([&](const auto&... p) { (table.keys.push_back(describe(p)), ...); }, T::choices);
  for (const auto& p : T::parameters) table.keys.push_back(describe(p, path_in_axis(name, p.key)));
  out.push_back(std::move(table));
  const auto describe_subtable = [&]<class Member>(const Subtable<Owner, Member>& s) {
    const std::string child = name.empty() ? std::string(s.key) : fmt::format("{}.{}", name, s.key);
    std::string when = s.presence == Presence::required ? "required" : "optional";
    if (s.presence == Presence::by_motor_model) when = need_of(s.key);
    if (s.presence == Presence::by_structure) when = "required without controller";
    describe_table<typename Unwrapped<Member>::type>(child, when, out);
  };
  std::apply([&](const auto&... s) { (describe_subtable(s), ...); }, T::subtables);
}

std::vector<KeyDescription> describe(const ValueTable& table) {
  std::vector<KeyDescription> keys;
  for (const ValueKey& key : table.keys) keys.push_back(describe(key, key.list ? ValueKind::list : ValueKind::number));
  return keys;
}

void describe_friction_models(const Vocabulary& vocabulary, std::vector<TableDescription>& out) {
  for (const ValueTable& model : vocabulary.friction_models)
    out.push_back({fmt::format("axis.NAME.friction.{}", model.name), "optional; at least the model in use",
                   fmt::format("friction model {}", model.text), describe(model)});
}

void describe_effects(const Vocabulary& vocabulary, std::vector<TableDescription>& out) {
  for (const ValueTable& effect : vocabulary.effects) {
    TableDescription table{fmt::format("[axis.NAME.{}]", effect_key),
                           effect.several ? "any number" : "at most one an axis",
                           fmt::format("effect {}: {}", effect.name, effect.text), describe(effect)};
    KeyDescription name;
    name.key = effect_name_key;
    name.allowed = fmt::format("\"{}\"", effect.name);
    name.fallback = "required";
    name.text = "name of the effect";
    name.expected = name.allowed;
    table.keys.insert(table.keys.begin(), name);
    out.push_back(std::move(table));
  }
}

KeyDescription expected_key_description(std::string_view key, std::string_view allowed, bool required,
                                        std::string_view text) {
  KeyDescription description;
  description.key = key;
  description.allowed = allowed;
  description.fallback = required ? "required" : "left out";
  description.text = text;
  description.expected = fmt::format("{} ({})", allowed, text);
  return description;
}

void describe_expected(std::vector<TableDescription>& out) {
  TableDescription table{fmt::format("[{}]", expected_key), "any number", std::string(expected_text), {}};
  for (const auto& text : expected_texts)
    table.keys.push_back(expected_key_description(
        text.key, "a text", std::holds_alternative<std::string ExpectedFigure::*>(text.member), text.text));
  for (const auto& quantity : expected_quantities)
    table.keys.push_back(expected_key_description(quantity.key, "a number with its unit", true, quantity.text));
  table.keys.push_back(expected_key_description(when_key, "a table", false, when_text));
  out.push_back(std::move(table));
}

}  // namespace

std::vector<TableDescription> machine_file_description(const Vocabulary& vocabulary) {
  std::vector<TableDescription> out;
  describe_table<Machine>("", "required", out);
  describe_table<AxisModel>("axis.NAME", "at least one", out);
  describe_friction_models(vocabulary, out);
  describe_effects(vocabulary, out);
  describe_table<DriveSetup>("drive", "optional", out);
  describe_table<DriveAxisSetup>("drive.axis.NAME", "optional", out);
  describe_table<CircleReference>("[reference.circle]", "any number", out);
  describe_table<SteadyFrictionReference>("[reference.steady_friction]", "any number", out);
  describe_table<PreslidingReference>("[reference.presliding]", "any number", out);
  describe_expected(out);
  KeyDescription schema;
  schema.key = "schema";
  schema.allowed = fmt::format("\"{}\"", machine_schema);
  schema.fallback = "required";
  schema.text = "the format of this file";
  schema.expected = schema.allowed;
  out.front().keys.insert(out.front().keys.begin(), schema);
  return out;
}

std::string describe_range(const Range& range, std::string_view unit) {
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  const std::string lowest = with_unit(range.low, unit);
  const std::string highest = with_unit(range.high, unit);
  if (low && high && !range.low_open) return fmt::format("from {} to {}", lowest, highest);
  if (low && high) return fmt::format("greater than {} and at most {}", lowest, highest);
  if (low) return fmt::format("{} {}", range.low_open ? "greater than" : "of at least", lowest);
  if (high) return fmt::format("of at most {}", highest);
  return {};
}

std::string describe_expectation(ValueKind kind, const Range& range, std::string_view unit, std::string_view text) {
  std::string_view noun = unit == "1" ? "a number" : "a value";
  if (kind == ValueKind::whole_number) noun = "a whole number";
  if (kind == ValueKind::list) noun = unit == "1" ? "a list of numbers" : "a list of values";
  std::string limits = describe_range(range, unit);
  if (limits.empty() && unit != "1") limits = fmt::format("in {}", unit);
  return fmt::format("{}{}{} ({})", noun, limits.empty() ? "" : " ", limits, text);
}

std::string quoted_list(const std::vector<std::string_view>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
    list += fmt::format("\"{}\"", names[i]);
  }
  return list;
}

}  // namespace stiction::machine
