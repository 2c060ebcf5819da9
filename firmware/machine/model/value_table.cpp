#include "firmware/machine/model/value_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stiction::machine {
namespace {

void check_value(const ValueTable& table, const ValueKey& key, const std::vector<double>& values) {
  for (const double value : values)
    if (!key.range.contains(value))
      throw ValueError(table.name, fmt::format("{} = {:g} {}", key.key, value, key.unit),
                       "a value in the range of this key");
  if (!key.list && values.size() != 1)
    throw ValueError(table.name, fmt::format("{} values of {}", values.size(), key.key), "one value");
  if (key.rising && std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end())
    throw ValueError(table.name, fmt::format("values of {} that do not rise", key.key), "each above the one before it");
}

void check_length(const ValueTable& table, const ValueKey& key, const KeyedValues& values) {
  const auto own = values.find(key.key), other = values.find(key.as_long_as);
  const std::size_t wanted = other == values.end() ? 0 : other->second.size();
  if (own != values.end() && own->second.size() != wanted)
    throw ValueError(table.name, fmt::format("a list of {} as {}", own->second.size(), key.key),
                     fmt::format("a list of {}, as many as {} has", wanted, key.as_long_as));
}

}  // namespace

void check_values(const ValueTable& table, const KeyedValues& values) {
  for (const auto& given : values)
    if (std::none_of(table.keys.begin(), table.keys.end(), [&](const ValueKey& key) { return key.key == given.first; }))
      throw ValueError(table.name, fmt::format("the key {}", given.first), "none but its own keys");
  for (const ValueKey& key : table.keys) {
    const auto found = values.find(key.key);
    if (found != values.end())
      check_value(table, key, found->second);
    else if (!key.optional && !key.fallback)
      throw ValueError(table.name, fmt::format("no {}", key.key), "one");
    if (!key.as_long_as.empty()) check_length(table, key, values);
  }
}

std::vector<double> values_at(const ConstPlace& place) {
  return std::visit(
      []<class Value>(const Value* value) -> std::vector<double> {
        if constexpr (std::is_same_v<Value, std::vector<double>>)
          return *value;
        else if constexpr (std::is_same_v<Value, std::optional<double>>)
          return *value ? std::vector{**value} : std::vector<double>{};
        else
          return {static_cast<double>(*value)};
      },
      place);
}

void put(const Place& place, const std::vector<double>& values) {
  if (values.empty()) return;
  std::visit(
      [&]<class Value>(Value* value) {
        if constexpr (std::is_same_v<Value, std::vector<double>>)
          *value = values;
        else
          *value = static_cast<Value>(values.front());
      },
      place);
}

std::vector<double> given_or_default(const KeyedValues& values, const ValueKey& key) {
  const auto found = values.find(key.key);
  if (found != values.end() && !found->second.empty()) return found->second;
  return key.fallback ? std::vector{*key.fallback} : std::vector<double>{};
}

}  // namespace stiction::machine
