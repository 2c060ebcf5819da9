#include "firmware/machine/file/edited_machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/expected_parameters.hpp"

namespace stiction::machine {
namespace {

void apply(toml::table& table, const MachineEdit& edit, std::size_t depth);

void insert(toml::table& table, const std::string& key, const MachineEdit& edit) {
  if (std::holds_alternative<std::monostate>(edit.value)) {
    table.erase(key);
  } else if (const auto* number = std::get_if<double>(&edit.value)) {
    table.insert_or_assign(key, *number);
  } else if (const auto* text = std::get_if<std::string>(&edit.value)) {
    table.insert_or_assign(key, *text);
  } else {
    toml::array list;
    for (const auto& item : std::get<std::vector<std::string>>(edit.value)) list.push_back(item);
    table.insert_or_assign(key, std::move(list));
  }
}

void descend(toml::table& table, const std::string& key, const MachineEdit& edit, std::size_t depth) {
  toml::node* node = table.get(key);
  const bool removes = std::holds_alternative<std::monostate>(edit.value);
  if (node == nullptr && removes) return;
  if (node == nullptr) node = &table.insert(key, toml::table{}).first->second;
  if (node->is_table()) apply(*node->as_table(), edit, depth);
}

void apply(toml::table& table, const MachineEdit& edit, std::size_t depth) {
  const std::string& key = edit.path[depth];
  if (depth + 1 == edit.path.size()) return insert(table, key, edit);
  if (key != "*") return descend(table, key, edit, depth + 1);
  for (auto&& [name, node] : table)
    if (node.is_table()) apply(*node.as_table(), edit, depth + 1);
}

}  // namespace

std::string edited_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                           std::span<const MachineEdit> edits, std::span<const std::string> comment) {
  std::ifstream stream(file, std::ios::binary);
  Document document(file.string(), {std::istreambuf_iterator<char>(stream), {}});
  for (const auto& assignment : set) document.apply_set(assignment);
  toml::table root = document.root();
  for (const auto& edit : edits) apply(root, edit, 0);
  if (!set.empty() || !edits.empty()) root.erase(expected_key);  // they are of the machine before
  std::ostringstream out;
  for (const auto& line : comment) out << "# " << line << '\n';
  out << root << '\n';
  return out.str();
}

std::string written_quantity(double value, std::string_view unit) { return fmt::format("{:.7g} {}", value, unit); }

}  // namespace stiction::machine
