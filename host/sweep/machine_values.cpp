#include "host/sweep/machine_values.hpp"

#include <fmt/format.h>

#include <optional>

#include "firmware/machine/file/units.hpp"
#include "host/sweep/round_number.hpp"

namespace stiction::host {
namespace {

constexpr std::string_view every_axis = "axis.*.";

const toml::node* node_at(const toml::table& root, std::string_view key) {
  const toml::table* table = &root;
  for (;;) {
    const auto dot = key.find('.');
    const toml::node* node = table->get(key.substr(0, dot));
    if (node == nullptr || dot == std::string_view::npos) return node;
    table = node->as_table();
    if (table == nullptr) return nullptr;
    key.remove_prefix(dot + 1);
  }
}

// As TOML; none of what is no number.
std::optional<std::string> times(const toml::node& node, double factor) {
  if (const auto* list = node.as_array()) {
    std::string all;
    for (auto&& each : *list) {
      const auto one = times(each, factor);
      if (!one) return std::nullopt;
      all += (all.empty() ? "[" : ", ") + *one;
    }
    return all.empty() ? std::nullopt : std::optional(all + "]");
  }
  if (node.is_number()) return fmt::format("{}", round_number(*node.value<double>() * factor));
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  const std::string unit(machine::unit_of(text->get()));
  try {
    const double value = machine::parse_quantity(text->get(), unit.empty() ? "1" : unit);
    return fmt::format("\"{}\"", quantity_text(round_number(value * factor), unit));
  } catch (const machine::UnitError&) {
    return std::nullopt;
  }
}

}  // namespace

MachineValues::MachineValues(const std::string& name, const std::string& experiment)
    : file_(machine::find_machine(name).string()), document_(file_, machine::content_of(file_)) {
  if (!experiment.empty()) document_.apply_experiment(experiment);
}

std::vector<std::string> MachineValues::multiplied(const std::string& key, double factor) const {
  std::vector<std::string> keys;
  if (key.starts_with(every_axis)) {
    if (const auto* axes = node_at(document_.root(), "axis"); axes != nullptr && axes->is_table())
      for (auto&& [name, axis] : *axes->as_table())
        keys.push_back(fmt::format("axis.{}.{}", name.str(), key.substr(every_axis.size())));
  } else {
    keys.push_back(key);
  }
  std::vector<std::string> all;
  for (const auto& each : keys) {
    const auto* node = node_at(document_.root(), each);
    if (node == nullptr) continue;
    const auto value = times(*node, factor);
    if (!value)
      document_.fail(node->source(), each, machine::describe_node(*node),
                     "a quantity or a list of quantities, which a sweep can multiply");
    all.push_back(fmt::format("{}={}", each, *value));
  }
  if (all.empty())
    throw machine::MachineFileError(fmt::format(
        "{}: {}: found no such key; expected one that the file has, since the sweep multiplies its value", file_, key));
  return all;
}

}  // namespace stiction::host
