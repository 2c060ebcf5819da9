// One TOML table of quantities, texts and tables below it, for files that are no machine files: motion files, projects.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/units.hpp"

namespace stiction::machine {

// Reads one table of a file of keys with quantities in units; every message names the place of the key.
class QuantityTable {
 public:
  // The `table` at `path` of `document`, which must stay as long as this does.
  QuantityTable(const Document& document, const toml::table& table, std::string path)
      : document_(document), table_(table), path_(std::move(path)) {}

  const toml::table& table() const { return table_; }
  std::string key(std::string_view name) const { return join_key(path_, name); }
  bool has(std::string_view name) const { return table_.contains(name); }

  void allow(const std::vector<std::string_view>& known) const {
    for (auto&& [name, node] : table_)
      if (std::find(known.begin(), known.end(), name.str()) == known.end())
        document_.fail_unknown(name.source(), key(name.str()), known);
  }

  // Throws MachineFileError at the key `name`: what was `found`, and what was `expected`.
  [[noreturn]] void fail(std::string_view name, std::string_view found, std::string_view expected) const {
    const toml::node* node = table_.get(name);
    document_.fail(node == nullptr ? table_.source() : node->source(), key(name), found, expected);
  }
  // The sentence "found ...; expected ..." of a check, at the table or one of its keys.
  [[noreturn]] void fail(const std::string& problem) const {
    throw MachineFileError(fmt::format("{}: {}", document_.place(table_.source(), path_), problem));
  }

  // The quantity of the key `name` in `unit`; none where the key is absent and not `required`. `text`: what it is, for
  // messages.
  std::optional<double> quantity(std::string_view name, std::string_view unit, std::string_view text,
                                 bool required = false) const {
    const toml::node* node = table_.get(name);
    if (node != nullptr) return quantity_of(*node, key(name), unit, text);
    if (required) fail(name, "no such key", expectation(unit, text));
    return std::nullopt;
  }

  // One quantity or a list of them, of the key `name` in `unit`; empty where the key is absent. `text` as above.
  std::vector<double> quantities(std::string_view name, std::string_view unit, std::string_view text) const {
    const toml::node* node = table_.get(name);
    if (node == nullptr) return {};
    std::vector<double> values;
    if (const auto* list = node->as_array())
      for (auto&& each : *list) values.push_back(quantity_of(each, key(name), unit, text));
    else
      values.push_back(quantity_of(*node, key(name), unit, text));
    return values;
  }

  std::optional<std::string> text(std::string_view name, std::string_view what) const {
    const toml::node* node = table_.get(name);
    if (node == nullptr) return std::nullopt;
    const auto* value = node->as_string();
    if (value == nullptr || value->get().empty()) fail(name, describe_node(*node), fmt::format("a text ({})", what));
    return value->get();
  }

  // The text of the key `name`, one of `names`; `fallback` where the key is absent. `what`: what it is, for messages.
  std::string choice(std::string_view name, const std::vector<std::string_view>& names, std::string_view fallback,
                     std::string_view what) const {
    const auto given = text(name, what);
    if (!given) return std::string(fallback);
    if (std::find(names.begin(), names.end(), *given) == names.end())
      fail(name, fmt::format("\"{}\"", *given),
           fmt::format("{} ({}){}", quoted_list(names), what, did_you_mean(*given, names)));
    return *given;
  }

  // The truth of the key `name`; `fallback` where it is absent. `what`: what it is, for messages.
  bool boolean(std::string_view name, bool fallback, std::string_view what) const {
    const toml::node* node = table_.get(name);
    if (node == nullptr) return fallback;
    if (!node->is_boolean()) fail(name, describe_node(*node), fmt::format("true or false ({})", what));
    return node->as_boolean()->get();
  }

  std::optional<QuantityTable> subtable(std::string_view name, std::string_view what) const {
    const toml::node* node = table_.get(name);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) fail(name, describe_node(*node), fmt::format("a table ({})", what));
    return QuantityTable(document_, *node->as_table(), key(name));
  }

  std::vector<QuantityTable> subtables(std::string_view name, std::string_view what) const {
    std::vector<QuantityTable> tables;
    const toml::node* node = table_.get(name);
    if (node == nullptr) return tables;
    const auto* list = node->as_array();
    if (list == nullptr) fail(name, describe_node(*node), fmt::format("[[{}]] ({})", key(name), what));
    for (auto&& each : *list) {
      if (!each.is_table()) fail(name, describe_node(each), fmt::format("tables [[{}]] ({})", key(name), what));
      tables.emplace_back(document_, *each.as_table(), fmt::format("{}[{}]", key(name), tables.size() + 1));
    }
    return tables;
  }

  // The rows of numbers of the key `name`, all of the same length from `least` to `most`.
  std::vector<std::vector<double>> rows(std::string_view name, std::size_t least, std::size_t most) const {
    const toml::node* node = table_.get(name);
    const std::string expected = fmt::format("a list of rows of {} to {} numbers", least, most);
    if (node == nullptr) fail(name, "no such key", expected);
    if (!node->is_array()) fail(name, describe_node(*node), expected);
    std::vector<std::vector<double>> rows;
    for (auto&& each : *node->as_array()) {
      const auto* list = each.as_array();
      if (list == nullptr) document_.fail(each.source(), key(name), describe_node(each), expected);
      std::vector<double> row;
      for (auto&& cell : *list) {
        const auto number = cell.value<double>();
        if (!number || cell.is_boolean()) document_.fail(cell.source(), key(name), describe_node(cell), "a number");
        row.push_back(*number);
      }
      if (row.size() < least || row.size() > most || (!rows.empty() && row.size() != rows.front().size()))
        document_.fail(each.source(), key(name), fmt::format("a row of {} numbers", row.size()),
                       rows.empty() ? expected : fmt::format("{} as in the first row", rows.front().size()));
      rows.push_back(std::move(row));
    }
    return rows;
  }

 private:
  static std::string expectation(std::string_view unit, std::string_view text) {
    return unit == "1" ? fmt::format("a number ({})", text) : fmt::format("a quantity in {} ({})", unit, text);
  }

  double quantity_of(const toml::node& node, const std::string& key, std::string_view unit,
                     std::string_view text) const {
    const std::string expected = expectation(unit, text);
    if (unit == "1" && node.is_number()) {
      const double number = *node.value<double>();
      if (std::isfinite(number)) return number;
    }
    const auto* words = node.as_string();
    if (words == nullptr) document_.fail(node.source(), key, describe_node(node), expected);
    try {
      return parse_quantity(words->get(), unit);
    } catch (const UnitError& error) {
      document_.fail(node.source(), key, fmt::format("\"{}\" ({})", words->get(), error.what()), expected);
    }
  }

  const Document& document_;
  const toml::table& table_;
  std::string path_;
};

}  // namespace stiction::machine
