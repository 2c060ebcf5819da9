#include "firmware/machine/file/expected_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/expected_parameters.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/units.hpp"

namespace stiction::machine {
namespace {

std::vector<std::string_view> known_experiments() {
  std::vector<std::string_view> names(experiment_names.begin(), experiment_names.end());
  names.push_back(identification_of_references);
  return names;
}

// One row in the making.
class RowReader {
 public:
  RowReader(const Document& document, std::span<const std::string_view> models, const toml::table& table,
            std::string path)
      : document_(document), models_(models), table_(table), path_(std::move(path)) {}

  ExpectedFigure read(const Machine& machine) {
    refuse_unknown();
    row_.place = document_.place(table_.source(), path_);
    for (const auto& text : expected_texts) read_text(text);
    for (const auto& quantity : expected_quantities) row_.*quantity.member = quantity_text(quantity);
    check_name("experiment", row_.experiment, known_experiments(), "an experiment");
    std::vector<std::string_view> axes;
    for (const AxisModel& axis : machine.axes) axes.push_back(axis.name);
    if (row_.axis) check_name("axis", *row_.axis, axes, "an axis of this machine");
    if (!row_.axis && axes.size() == 1) row_.axis = axes.front();
    if (row_.friction) check_name("friction", *row_.friction, {models_.begin(), models_.end()}, "a friction model");
    check_tolerance();
    read_when();
    return std::move(row_);
  }

 private:
  void refuse_unknown() const {
    std::vector<std::string_view> known;
    for (const auto& text : expected_texts) known.push_back(text.key);
    for (const auto& quantity : expected_quantities) known.push_back(quantity.key);
    known.push_back(when_key);
    for (auto&& [key, value] : table_)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        document_.fail_unknown(key.source(), join_key(path_, key.str()), known);
  }

  [[noreturn]] void fail(std::string_view key, const std::string& expected, std::string_view why = {}) const {
    const toml::node* node = table_.get(key);
    document_.fail(
        node == nullptr ? table_.source() : node->source(), join_key(path_, key),
        (node == nullptr ? "no such key" : describe_node(*node)) + (why.empty() ? "" : fmt::format(" ({})", why)),
        expected);
  }

  void read_text(const ExpectedText& text) {
    const toml::node* node = table_.get(text.key);
    if (node == nullptr && !std::holds_alternative<std::string ExpectedFigure::*>(text.member)) return;
    const auto* value = node == nullptr ? nullptr : node->as_string();
    if (value == nullptr || value->get().empty()) fail(text.key, fmt::format("a text ({})", text.text));
    std::visit([&](auto member) { row_.*member = value->get(); }, text.member);
  }

  // As it is written; a plain number is one without unit.
  std::string quantity_text(const ExpectedQuantity& quantity) const {
    const auto expected = fmt::format("a number with its unit ({})", quantity.text);
    const toml::node* node = table_.get(quantity.key);
    if (node != nullptr && node->is_number()) return fmt::format("{}", *node->value<double>());
    if (node == nullptr || !node->is_string()) fail(quantity.key, expected);
    const auto& text = node->as_string()->get();
    try {
      const auto unit = unit_of(text);
      parse_quantity(text, unit.empty() ? "1" : unit);
    } catch (const UnitError& error) {
      fail(quantity.key, expected, error.what());
    }
    return text;
  }

  void check_tolerance() const {
    const auto unit = unit_of(row_.value);
    try {
      if (parse_quantity(row_.tolerance, unit.empty() ? "1" : unit) >= 0.0) return;
    } catch (const UnitError& error) {
      fail("tolerance", "a tolerance in a unit of the value's dimension", error.what());
    }
    fail("tolerance", "a tolerance of at least 0");
  }

  void check_name(std::string_view key, std::string_view name, const std::vector<std::string_view>& known,
                  std::string_view what) const {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    fail(key, fmt::format("{}: {}{}", what, quoted_list(known), did_you_mean(name, known)));
  }

  void read_when() {
    const toml::node* when = table_.get(when_key);
    if (when == nullptr) return;
    if (!when->is_table()) fail(when_key, fmt::format("a table ({})", when_text));
    for (auto&& [key, value] : *when->as_table()) {
      const auto path = fmt::format("{}.{}", join_key(path_, when_key), key.str());
      if (value.is_table() || value.is_array())
        document_.fail(value.source(), path, describe_node(value), "a text or a number, with the whole key in quotes");
      const auto* text = value.as_string();
      const std::string content = text != nullptr ? text->get() : describe_node(value);
      if (key.str().find('.') == std::string_view::npos)
        read_option(value, path, std::string(key.str()), content);
      else
        add_override(fmt::format("{}={}", key.str(), content));
    }
  }

  void add_override(const std::string& assignment) {
    row_.overrides.push_back(assignment);
    add_setting(fmt::format("--set \"{}\"", assignment));
  }
  void add_setting(const std::string& text) { row_.settings += (row_.settings.empty() ? "" : " ") + text; }

  void read_option(const toml::node& node, const std::string& path, const std::string& name, const std::string& text) {
    for (const auto& option : experiment_options) {
      if (option.experiment != row_.experiment || option.option != name) continue;
      try {
        row_.options[name] = parse_quantity(text, option.unit);
        add_setting(fmt::format("--{} \"{}\"", name, text));
        return;
      } catch (const UnitError& error) {
        document_.fail(node.source(), path, fmt::format("{} ({})", describe_node(node), error.what()),
                       fmt::format("a value in {}", option.unit));
      }
    }
    document_.fail(node.source(), path, describe_node(node),
                   fmt::format("an override such as \"axis.X.mass\", or an option of {}", row_.experiment));
  }

  const Document& document_;
  std::span<const std::string_view> models_;
  const toml::table& table_;
  std::string path_;
  ExpectedFigure row_;
};

// ---- what is in force ----

std::optional<double> number_of(const toml::node& node, std::string_view unit) {
  if (node.is_number()) return unit.empty() ? node.value<double>() : std::nullopt;
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  try {
    return parse_quantity(text->get(), unit.empty() ? "1" : unit);
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

bool same_value(const toml::node& a, const toml::node& b) {
  const auto* text = b.as_string();
  const std::string_view unit = text == nullptr ? std::string_view() : unit_of(text->get());
  const auto x = number_of(a, unit), y = number_of(b, unit);
  if (x && y) return std::abs(*x - *y) <= 1e-9 * std::abs(*y);
  return describe_node(a) == describe_node(b);
}

// Whether two trees of keys are the same where `matters` (of a dotted path) says that it matters.
class Comparison {
 public:
  explicit Comparison(const ExpectedFigure& row) : row_(row) {}

  bool same(const toml::table& a, const toml::table& b, const std::string& above = "") const {
    std::set<std::string> keys;
    for (const auto* table : {&a, &b})
      for (auto&& [key, value] : *table) keys.insert(std::string(key.str()));
    return std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
      const auto path = join_key(above, key);
      return !matters(path) || same(a.get(key), b.get(key), path);
    });
  }

 private:
  bool same(const toml::node* a, const toml::node* b, const std::string& path) const {
    const auto* table_a = a == nullptr ? nullptr : a->as_table();
    const auto* table_b = b == nullptr ? nullptr : b->as_table();
    if (table_a != nullptr && table_b != nullptr) return same(*table_a, *table_b, path);
    if (a == nullptr || b == nullptr) {
      const auto* left = table_a != nullptr ? table_a : table_b;
      return left != nullptr && !anything_matters(*left, path);
    }
    if (table_a != nullptr || table_b != nullptr) return false;
    if (a->is_array() && b->is_array()) return same(*a->as_array(), *b->as_array(), path);
    return !a->is_array() && !b->is_array() && same_value(*a, *b);
  }
  bool same(const toml::array& a, const toml::array& b, const std::string& path) const {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!same(a.get(i), b.get(i), path)) return false;
    return true;
  }
  // Of a table that one of the two lacks.
  bool anything_matters(const toml::table& table, const std::string& above) const {
    return table.empty() || std::any_of(table.begin(), table.end(), [&](const auto& entry) {
             const auto path = join_key(above, entry.first.str());
             return matters(path) && (!entry.second.is_table() || anything_matters(*entry.second.as_table(), path));
           });
  }

  // Without influence on the figures of any experiment: names, tables of the drive's programme, other axes, other
  // friction models, and which model acts, as a row names the one that it is for.
  bool matters(const std::string& path) const {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= path.size();) {
      const auto end = std::min(path.find('.', begin), path.size());
      parts.push_back(path.substr(begin, end - begin));
      begin = end + 1;
    }
    if (parts[0] != "axis" && parts[0] != "timing" && parts[0] != "feed_drive") return false;
    if (parts[0] != "axis" || parts.size() < 2) return true;
    if (row_.axis && parts[1] != *row_.axis) return false;
    if (parts.size() < 4 || parts[2] != "friction") return true;
    return parts[3] != "use" && (!row_.friction || parts[3] == *row_.friction);
  }

  const ExpectedFigure& row_;
};

}  // namespace

std::vector<ExpectedFigure> read_expected_figures(const Document& document, const Machine& machine,
                                                  std::span<const std::string_view> models) {
  std::vector<ExpectedFigure> rows;
  const toml::node* node = document.root().get(expected_key);
  if (node == nullptr) return rows;
  if (!node->is_array())
    document.fail(node->source(), expected_key, describe_node(*node), fmt::format("rows [[{}]]", expected_key));
  using Key = std::tuple<std::string, std::optional<std::string>, std::optional<std::string>, std::string,
                         std::map<std::string, double>, std::vector<std::string>>;
  std::map<Key, std::string> seen;
  for (const toml::node& element : *node->as_array()) {
    const auto path = fmt::format("{}[{}]", expected_key, rows.size());
    if (!element.is_table())
      document.fail(element.source(), path, describe_node(element), fmt::format("a table ({})", expected_text));
    rows.push_back(RowReader(document, models, *element.as_table(), path).read(machine));
    const auto& row = rows.back();
    const auto [twin, unique] =
        seen.try_emplace({row.experiment, row.axis, row.friction, row.figure, row.options, row.overrides}, path);
    if (!unique)
      document.fail(element.source(), path, fmt::format("the figure of {} again", twin->second),
                    "one row for each figure, axis, friction model and set of overrides");
  }
  return rows;
}

void mark_in_force(std::vector<ExpectedFigure>& rows, const Document& file, const Document& running,
                   const std::string& experiment, const DocumentWith& with) {
  std::set<std::pair<std::string, std::vector<std::string>>> tried;
  for (auto& row : rows) {
    if (row.overrides.empty()) {
      row.in_force = Comparison(row).same(file.root(), running.root());
      continue;
    }
    try {
      if (tried.emplace(row.experiment, row.overrides).second) with(row.experiment, row.overrides);
    } catch (const MachineFileError& error) {
      throw MachineFileError(fmt::format("{}.{}: found {} ({}); expected overrides that this file takes", row.place,
                                         when_key, fmt::join(row.overrides, ", "), error.what()));
    }
    if (row.experiment == experiment)
      row.in_force = Comparison(row).same(with(experiment, row.overrides).root(), running.root());
  }
}

}  // namespace stiction::machine
