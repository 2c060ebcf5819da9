#include "host/sweep/spec.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include "firmware/machine/file/quantity_table.hpp"
#include "host/sweep/round_number.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;
using machine::QuantityTable;

constexpr std::uint64_t most_rows = std::uint64_t{1} << 62U;
constexpr std::int64_t most_samples = std::int64_t{1} << 32U;

// Keys of a table that says how a value varies; a table with none of them holds further keys of the machine.
constexpr std::array<std::string_view, 10> variation_keys{"values",       "from", "to",        "steps",    "scale",
                                                          "distribution", "mean", "deviation", "relative", "design"};

// A quantity or a plain number as a key has it.
struct Number {
  double value = 0.0;
  std::string unit;  // empty: none
};

std::optional<Number> number_of(const toml::node& node) {
  if (node.is_number()) return Number{*node.value<double>(), ""};
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  const std::string unit(machine::unit_of(text->get()));
  try {
    return Number{machine::parse_quantity(text->get(), unit.empty() ? "1" : unit), unit};
  } catch (const machine::UnitError&) {
    return std::nullopt;
  }
}

std::string text_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  return fmt::format("{}", *node.value<double>());
}

class SpecReader {
 public:
  SpecReader(const std::string& file, const std::string& text)
      : document_(file, text), root_(document_, document_.root(), "") {
    spec_.file = file;
    spec_.text = text;
  }

  SweepSpec read() {
    root_.allow({"schema", "name", "command", "machine", "log", "option", "set", "sample", "figures", "pareto", "worst",
                 "robust"});
    if (root_.text("schema", "the format") != sweep_spec_schema)
      root_.fail("schema", root_.has("schema") ? "a different one" : "no such key",
                 fmt::format("\"{}\"", sweep_spec_schema));
    spec_.name = root_.text("name", "what the sweep shows").value_or(fs::path(spec_.file).stem().string());
    const auto command = root_.text("command", "a command such as \"simulate circle\"");
    if (!command) root_.fail("command", "no such key", "a command such as \"simulate circle\"");
    spec_.command = *command;
    if (!root_.has("machine")) root_.fail("machine", "no such key", "the machine, or a list of them");
    add_key(SweptKey::Kind::machine, "machine", *root_.table().get("machine"), "machine");
    if (root_.has("log")) add_key(SweptKey::Kind::log, "log", *root_.table().get("log"), "log");
    if (const auto options = root_.subtable("option", "options of the command"))
      for (auto&& [name, node] : options->table())
        add_key(SweptKey::Kind::option, std::string(name.str()), node, options->key(name.str()));
    if (const auto set = root_.subtable("set", "keys of the machine file")) add_set(set->table(), "", "set");
    spec_.figures = texts("figures", "names of figures");
    spec_.pareto = texts("pareto", "names of two figures");
    if (!spec_.pareto.empty() && spec_.pareto.size() != 2)
      root_.fail("pareto", fmt::format("a list of {}", spec_.pareto.size()), "two figures, both better when smaller");
    spec_.worst = root_.text("worst", "a figure").value_or("");
    spec_.robust = root_.text("robust", "a figure").value_or("");
    read_sample();
    check_design();
    return std::move(spec_);
  }

 private:
  std::vector<std::string> texts(std::string_view name, std::string_view what) {
    std::vector<std::string> all;
    const auto* node = root_.table().get(name);
    if (node == nullptr) return all;
    const auto* list = node->as_array();
    if (list == nullptr || list->empty())
      root_.fail(name, list == nullptr ? machine::describe_node(*node) : "an empty list",
                 fmt::format("a list of {}", what));
    for (auto&& each : *list) {
      if (!each.is_string())
        document_.fail(each.source(), name, machine::describe_node(each), fmt::format("a text ({})", what));
      all.push_back(each.as_string()->get());
    }
    return all;
  }

  void add_set(const toml::table& table, const std::string& above, const std::string& place) {
    for (auto&& [name, node] : table) {
      const auto key = machine::join_key(above, name.str());
      const auto* inner = node.as_table();
      const bool varies = inner == nullptr || std::any_of(variation_keys.begin(), variation_keys.end(),
                                                          [&](std::string_view each) { return inner->contains(each); });
      if (varies)
        add_key(SweptKey::Kind::set, key, node, place + "." + key);
      else
        add_set(*inner, key, place);
    }
  }

  void add_key(SweptKey::Kind kind, std::string name, const toml::node& node, const std::string& place) {
    SweptKey key;
    key.kind = kind;
    key.name = std::move(name);
    const bool name_of_file = kind == SweptKey::Kind::machine || kind == SweptKey::Kind::log;
    if (name_of_file && node.is_table())
      document_.fail(node.source(), place, "a table", "a name, a path or a list of them");
    if (const auto* table = node.as_table())
      read_variation(key, *table, place);
    else
      read_values(key, node, place);
    spec_.keys.push_back(std::move(key));
  }

  // One value, or a list of them.
  void read_values(SweptKey& key, const toml::node& node, const std::string& place) {
    std::vector<const toml::node*> nodes;
    if (const auto* list = node.as_array()) {
      for (auto&& each : *list) nodes.push_back(&each);
      if (nodes.empty()) document_.fail(node.source(), place, "an empty list", "at least one value");
    } else {
      nodes.push_back(&node);
    }
    for (const auto* each : nodes) {
      if (!each->is_string() && !each->is_number() && !each->is_boolean())
        document_.fail(each->source(), place, machine::describe_node(*each), "a text, a number or a list of them");
      if (each->is_string() && each->as_string()->get().find('\n') != std::string::npos)
        document_.fail(each->source(), place, "a text of several lines", "a text of one line");
      key.values.push_back(text_of(*each));
    }
    const auto first = number_of(*nodes.front());
    key.numeric = first.has_value();
    if (first) key.unit = first->unit;
    for (const auto* each : nodes) {
      if (!key.numeric) break;
      const auto number = number_of(*each);
      const auto value = number ? in_unit(*number, key.unit) : std::nullopt;
      key.numeric = value.has_value();
      if (value) key.numbers.push_back(*value);
    }
    if (!key.numeric) {
      key.unit.clear();
      key.numbers.clear();
    }
  }

  static std::optional<double> in_unit(const Number& number, const std::string& unit) {
    if (number.unit == unit) return number.value;
    try {
      return machine::parse_quantity(fmt::format("{} {}", number.value, number.unit), unit);
    } catch (const machine::UnitError&) {
      return std::nullopt;
    }
  }

  void read_variation(SweptKey& key, const toml::table& table, const std::string& place) {
    const QuantityTable values(document_, table, place);
    values.allow({variation_keys.begin(), variation_keys.end()});
    key.relative = values.boolean("relative", false, "whether numbers are factors of the values in the machine file");
    key.design = values.boolean("design", false, "whether the search for the best worst case chooses it");
    if (key.relative && key.kind != SweptKey::Kind::set)
      values.fail("relative", "true", "a key of the machine file, in [set]");
    if (values.has("values")) {
      refuse_beside(values, "values", {"from", "to", "steps", "scale", "distribution", "mean", "deviation"});
      read_values(key, *table.get("values"), place + ".values");
      if (key.relative && (!key.numeric || !key.unit.empty()))
        values.fail("values", "values that are no plain numbers", "factors, since the key is relative");
      return;
    }
    if (values.has("steps"))
      read_range(key, values);
    else
      read_distribution(key, values);
  }

  void refuse_beside(const QuantityTable& values, std::string_view present,
                     const std::vector<std::string_view>& others) const {
    for (const auto other : others)
      if (values.has(other)) values.fail(other, fmt::format("it together with {}", present), "one of them");
  }

  // The number of `name`; its unit becomes the key's, or must be of its dimension.
  double bound(SweptKey& key, const QuantityTable& values, std::string_view name, bool first) const {
    const auto* node = values.table().get(name);
    if (node == nullptr) values.fail(name, "no such key", "a number or a quantity");
    const auto number = number_of(*node);
    if (!number || !std::isfinite(number->value))
      values.fail(name, machine::describe_node(*node), "a number or a quantity");
    if (key.relative && !number->unit.empty())
      values.fail(name, machine::describe_node(*node), "a factor, since the key is relative");
    if (first) key.unit = number->unit;
    const auto value = in_unit(*number, key.unit);
    if (!value) values.fail(name, machine::describe_node(*node), fmt::format("a quantity in {}", key.unit));
    return *value;
  }

  void read_limits(SweptKey& key, const QuantityTable& values, bool logarithmic) const {
    key.low = bound(key, values, "from", true);
    key.high = bound(key, values, "to", false);
    if (logarithmic && !(key.low > 0.0)) values.fail("from", fmt::format("{:g}", key.low), "a value above 0");
    if (!(key.high > key.low))
      values.fail("to", fmt::format("{:g}", key.high), fmt::format("more than from, {:g}", key.low));
  }

  void read_range(SweptKey& key, const QuantityTable& values) const {
    refuse_beside(values, "steps", {"distribution", "mean", "deviation"});
    const bool logarithmic =
        values.choice("scale", {"linear", "logarithmic"}, "linear", "of the steps") == "logarithmic";
    read_limits(key, values, logarithmic);
    const auto* steps = values.table().get("steps")->as_integer();
    if (steps == nullptr || steps->get() < 2 || steps->get() > 1'000'000)
      values.fail("steps", machine::describe_node(*values.table().get("steps")), "a whole number from 2 to 1000000");
    const auto last = static_cast<double>(steps->get() - 1);
    for (std::int64_t k = 0; k < steps->get(); ++k) {
      const double share = static_cast<double>(k) / last;
      const double value =
          logarithmic ? key.low * std::pow(key.high / key.low, share) : key.low + (key.high - key.low) * share;
      key.numbers.push_back(round_number(value));
      key.values.push_back(quantity_text(key.numbers.back(), key.unit));
    }
  }

  void read_distribution(SweptKey& key, const QuantityTable& values) const {
    if (!values.has("distribution"))
      values.fail("distribution", "neither it nor steps", "how a value is drawn, or the steps of a range");
    const auto name = values.choice("distribution", {"uniform", "log-uniform", "normal"}, "", "how a value is drawn");
    if (name == "normal") {
      refuse_beside(values, "a normal distribution", {"from", "to", "scale"});
      key.drawn = Distribution::normal;
      key.low = bound(key, values, "mean", true);
      key.high = bound(key, values, "deviation", false);
      if (!(key.high > 0.0)) values.fail("deviation", fmt::format("{:g}", key.high), "more than 0");
      return;
    }
    refuse_beside(values, "this distribution", {"mean", "deviation", "scale"});
    key.drawn = name == "uniform" ? Distribution::uniform : Distribution::log_uniform;
    read_limits(key, values, key.drawn == Distribution::log_uniform);
  }

  void read_sample() {
    const auto drawn = static_cast<std::size_t>(
        std::count_if(spec_.keys.begin(), spec_.keys.end(), [](const SweptKey& key) { return key.drawn.has_value(); }));
    const auto table = root_.subtable("sample", "how many rows are drawn");
    if (!table) {
      if (drawn > 0)
        root_.fail("sample", "no such table, but keys with a distribution", "a table [sample] with number and seed");
      return;
    }
    table->allow({"method", "number", "seed"});
    if (drawn == 0) root_.fail("sample", "it without a key that has a distribution", "such a key, or not this table");
    const auto method = table->choice("method", {"latin-hypercube", "sobol"}, "latin-hypercube", "how rows are spread");
    spec_.method = method == "sobol" ? SampleMethod::sobol : SampleMethod::latin_hypercube;
    if (spec_.method == SampleMethod::sobol && drawn > sobol_dimensions)
      table->fail("method", fmt::format("sobol for {} keys", drawn),
                  fmt::format("at most {} keys with a distribution, or latin-hypercube", sobol_dimensions));
    spec_.samples = whole(*table, "number", 1, most_samples, std::nullopt);
    spec_.seed = whole(*table, "seed", 0, std::numeric_limits<std::int64_t>::max(), 1);
  }

  static std::uint64_t whole(const QuantityTable& table, std::string_view name, std::int64_t least, std::int64_t most,
                             std::optional<std::uint64_t> fallback) {
    const auto* node = table.table().get(name);
    const auto expected = fmt::format("a whole number from {} to {}", least, most);
    if (node == nullptr && fallback) return *fallback;
    if (node == nullptr) table.fail(name, "no such key", expected);
    const auto* number = node->as_integer();
    if (number == nullptr || number->get() < least || number->get() > most)
      table.fail(name, machine::describe_node(*node), expected);
    return static_cast<std::uint64_t>(number->get());
  }

  void check_design() const {
    const bool design =
        std::any_of(spec_.keys.begin(), spec_.keys.end(), [](const SweptKey& key) { return key.design; });
    if (design == !spec_.robust.empty()) {
      for (const auto& key : spec_.keys)
        if (key.design && key.drawn)
          root_.fail("set", fmt::format("the design key {} with a distribution", key.name), "its values or steps");
      return;
    }
    root_.fail("robust", design ? "design keys without it" : "it without a key that has design = true",
               "both: the figure whose worst case is made smallest, and what may be chosen for it");
  }

  machine::Document document_;
  QuantityTable root_;
  SweepSpec spec_;
};

std::vector<fs::path> folders() {
  std::vector<fs::path> found;
  if (const char* variable = std::getenv("STICTION_SWEEPS")) {
    std::istringstream list(variable);
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) found.emplace_back(folder);
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) found.push_back(program.parent_path().parent_path() / "share" / "stiction" / "sweeps");
  return found;
}

}  // namespace

std::string SweptKey::column() const {
  if (relative) return name + "[relative]";
  return unit.empty() ? name : fmt::format("{}[{}]", name, unit);
}

std::uint64_t SweepSpec::rows() const {
  std::uint64_t product = samples;
  for (const auto& key : keys) {
    const std::uint64_t each = std::max<std::size_t>(key.values.size(), 1);
    if (product > most_rows / each) return most_rows;
    product *= each;
  }
  return product;
}

SweepSpec parse_sweep_spec(const std::string& file, const std::string& text) { return SpecReader(file, text).read(); }

std::vector<std::string> shipped_sweeps() {
  std::set<std::string> names;
  for (const auto& folder : folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  }
  return {names.begin(), names.end()};
}

fs::path find_sweep(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  std::error_code error;
  const bool exists = fs::exists(path, error) && !fs::is_directory(path, error);
  if (exists || path.extension() == ".toml" || name_or_path.find('/') != std::string::npos) return path;
  for (const auto& folder : folders()) {
    const auto candidate = folder / (name_or_path + ".toml");
    if (!name_or_path.empty() && fs::exists(candidate, error)) return candidate;
  }
  const auto shipped = shipped_sweeps();
  throw machine::MachineFileError(
      fmt::format("sweep \"{}\": found {}; expected the path of a file or the name of a shipped sweep: {}{}",
                  name_or_path, fs::is_directory(path, error) ? "a folder" : "no such sweep",
                  shipped.empty() ? "none found" : fmt::format("{}", fmt::join(shipped, ", ")),
                  machine::did_you_mean(name_or_path, {shipped.begin(), shipped.end()})));
}

}  // namespace stiction::host
