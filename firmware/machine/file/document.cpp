#include "firmware/machine/file/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "firmware/machine/file/nearest_name.hpp"

namespace stiction::machine {
namespace {

// Where a node comes from is kept as the path of its source region.
constexpr std::string_view from_file = "file";
constexpr std::string_view from_experiment = "experiment.";
constexpr std::string_view from_set = "--set ";

// What overrides may change.
const std::vector<std::string_view> changeable{"name", "timing", "axis", "drive", "feed_drive"};

void merge(toml::table& into, toml::table& changes) {
  for (auto&& [key, value] : changes) {
    toml::node* present = into.get(key.str());
    if (present != nullptr && present->is_table() && value.is_table()) {
      merge(*present->as_table(), *value.as_table());
    } else {
      into.insert_or_assign(key, std::move(value));
    }
  }
}

toml::table* child(toml::table* table, std::string_view key) {
  toml::node* node = table == nullptr ? nullptr : table->get(key);
  return node == nullptr ? nullptr : node->as_table();
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

// KEY = VALUE as a tree of its own; a value that is no TOML is a text.
toml::table parse_assignment(const std::string& key, const std::string& value, const std::string& tag) {
  try {
    if (value.find('\n') == std::string::npos) return toml::parse(fmt::format("{} = {}", key, value), tag);
  } catch (const toml::parse_error&) {
  }
  return toml::parse(fmt::format("{} = {}", key, toml_string(value)), tag);
}

// Removes the one key that `path` leads to.
void remove_key(toml::table& from, const toml::table& path, const std::string& above, const std::string& tag) {
  for (auto&& [name, value] : path) {
    const std::string key = join_key(above, name.str());
    if (!from.contains(name.str()))
      throw MachineFileError(fmt::format("{}: {}: found nothing to remove; expected a key of the file", tag, key));
    if (!value.is_table()) {
      from.erase(name.str());
    } else if (toml::table* table = child(&from, name.str())) {
      remove_key(*table, *value.as_table(), key, tag);
    } else {
      throw MachineFileError(fmt::format("{}: {}: found a value; expected a table", tag, key));
    }
  }
}

// Whether `line` reads KEY = 8,5.
bool has_decimal_comma(std::string_view line) {
  constexpr std::string_view digits = "0123456789";
  for (std::size_t at = line.find('='); at != line.npos; at = line.find('=', at + 1)) {
    std::size_t number = std::min(line.find_first_not_of(" \t", at + 1), line.size());
    if (number < line.size() && (line[number] == '-' || line[number] == '+')) ++number;
    const std::size_t end = line.find_first_not_of(digits, number);
    if (end == line.npos || end == number || line[end] != ',') continue;
    if (end + 1 < line.size() && digits.find(line[end + 1]) != digits.npos) return true;
  }
  return false;
}

// " (...)" where the line has a decimal comma.
std::string comma_hint(const std::string& text, std::size_t line) {
  std::istringstream lines(text);
  std::string found;
  for (std::size_t k = 0; k < line && std::getline(lines, found);) ++k;
  return has_decimal_comma(found) ? " (a decimal comma; numbers have a decimal point, as in 8.5)" : "";
}

}  // namespace

Document::Document(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  try {
    root_ = toml::parse(text_, from_file);
  } catch (const toml::parse_error& error) {
    const std::size_t line = error.source().begin.line;
    throw MachineFileError(fmt::format("{}:{}: found invalid TOML: {}{}; expected a TOML file", file_, line,
                                       error.description(), comma_hint(text_, line)));
  }
}

std::string Document::place(const toml::source_region& place, std::string_view key) const {
  const std::string_view tag = place.path ? std::string_view(*place.path) : from_file;
  if (tag.starts_with(from_set)) return fmt::format("{}: {}", tag, key);
  const std::string prefix = tag.starts_with(from_experiment) ? fmt::format("{}.", tag) : "";
  return fmt::format("{}:{}: {}{}", file_, place.begin.line, prefix, key);
}

// Of a key at one place the first error is told: a table may be read twice, for what others need of it and for itself,
// and what follows from the first error is none of its own.
void Document::keep(std::string error) const {
  const auto place_and_key = error.substr(0, error.find(": found "));
  if (std::none_of(errors_.begin(), errors_.end(),
                   [&](const std::string& each) { return each.starts_with(place_and_key + ": found "); }))
    errors_.push_back(std::move(error));
}

void Document::report() const {
  if (errors_.empty()) return;
  throw MachineFileError(fmt::format("{}", fmt::join(errors_, "\n")));
}

void Document::fail(const toml::source_region& where, std::string_view key, std::string_view found,
                    std::string_view expected) const {
  throw MachineFileError(fmt::format("{}: found {}; expected {}", place(where, key), found, expected));
}

void Document::fail_unknown(const toml::source_region& place, std::string_view key,
                            const std::vector<std::string_view>& known) const {
  const std::size_t dot = key.rfind('.');
  const std::string_view name = dot == std::string_view::npos ? key : key.substr(dot + 1);
  fail(place, key, "an unknown key", fmt::format("one of {}{}", fmt::join(known, ", "), did_you_mean(name, known)));
}

void Document::apply_experiment(std::string_view name) {
  const std::string tag = fmt::format("{}{}", from_experiment, name);
  // Parsed again, because a tree's nodes can be moved into another with their places, but not copied.
  toml::table again = toml::parse(text_, tag);
  if (toml::table* changes = child(child(&again, "experiment"), name)) overlay(*changes);
}

void Document::refuse_unchangeable(const toml::table& changes) const {
  for (auto&& [key, value] : changes) {
    if (std::find(changeable.begin(), changeable.end(), key.str()) == changeable.end())
      fail_unknown(key.source(), key.str(), changeable);
  }
}

void Document::overlay(toml::table& changes) {
  refuse_unchangeable(changes);
  const toml::table* axes = child(&root_, "axis");
  if (const toml::table* changed = child(&changes, "axis"); axes != nullptr && changed != nullptr) {
    std::vector<std::string_view> known;
    for (auto&& [name, axis] : *axes) known.push_back(name.str());
    for (auto&& [name, axis] : *changed)
      if (!axes->contains(name.str())) fail_unknown(name.source(), join_key("axis", name.str()), known);
  }
  merge(root_, changes);
}

void Document::apply_set(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw MachineFileError(
        fmt::format("{}{}: found no KEY=VALUE; expected one, such as axis.X.mass=\"230 kg\"", from_set, assignment));
  const std::string key(assignment.substr(0, equals));
  const std::string value(assignment.substr(equals + 1));
  const std::string tag = fmt::format("{}{}", from_set, key);
  constexpr std::string_view every = "axis.*.";
  if (!key.starts_with(every)) return set_one(tag, key, value);
  std::vector<std::string> names;
  if (const toml::table* axes = child(&root_, "axis"))
    for (auto&& [name, axis] : *axes) names.emplace_back(name.str());
  for (const std::string& name : names) set_one(tag, fmt::format("axis.{}.{}", name, key.substr(every.size())), value);
}

void Document::set_one(const std::string& tag, const std::string& key, const std::string& value) {
  toml::table changes;
  try {
    changes = parse_assignment(key, value.empty() ? "0" : value, tag);
  } catch (const toml::parse_error&) {
    throw MachineFileError(fmt::format("{}: found no valid key; expected one such as axis.X.mass", tag));
  }
  if (value.empty()) {
    refuse_unchangeable(changes);
    remove_key(root_, changes, "", tag);
  } else {
    overlay(changes);
  }
}

std::string join_key(std::string_view table, std::string_view key) {
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

std::string describe_node(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", text->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{:#}", number->get());
  std::ostringstream out;
  toml::node_view<const toml::node>(node).visit([&](const auto& value) { out << value; });
  return out.str();
}

}  // namespace stiction::machine
