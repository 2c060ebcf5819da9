#include "firmware/machine/file/machine_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/machine/file/compensation_checks.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/machine/file/expected_figures.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/table_reader.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "stiction/control/compensation_kind.hpp"

namespace stiction::machine {
namespace {

// The node at a dotted path below `table`; nullptr when absent. `nearest` becomes the last table on the way.
const toml::node* node_at(const toml::table& table, std::string_view path, const toml::table** nearest = nullptr) {
  const toml::table* here = &table;
  while (true) {
    if (nearest != nullptr) *nearest = here;
    const std::size_t dot = path.find('.');
    const toml::node* node = here->get(path.substr(0, dot));
    if (node == nullptr || dot == std::string_view::npos) return node;
    if (!node->is_table()) return nullptr;
    here = node->as_table();
    path.remove_prefix(dot + 1);
  }
}

std::vector<std::string_view> friction_model_names(const Vocabulary& vocabulary) {
  std::vector<std::string_view> names;
  for (const ValueTable& model : vocabulary.friction_models) names.push_back(model.name);
  return names;
}

// A machine in the making: reads one merged document and checks what no single key's description can say.
class MachineReader {
 public:
  // `runs`: whether this machine is the one that will run. One that only an experiment's overrides make may have a
  // friction beside which an effect of the file cannot be (the presliding bench has other guides).
  MachineReader(const Document& document, const Vocabulary& vocabulary, bool runs = true)
      : document_(document), vocabulary_(vocabulary), root_(document.root()), runs_(runs) {}

  Machine read() {
    check_schema();
    machine_ = TableReader(document_, false).read<Machine>(root_, "");
    check_periods();
    read_axes();
    check_feed_drive();
    drive_setup_of(document_, machine_);
    check_experiments();
    read_references();
    machine_.expected = read_expected_figures(document_, machine_, friction_model_names(vocabulary_));
    return std::move(machine_);
  }

 private:
  void check_schema() const {
    const std::string expected = fmt::format("\"{}\"", machine_schema);
    const toml::node* schema = root_.get("schema");
    if (schema == nullptr) document_.fail(root_.source(), "schema", "no such key", expected);
    if (describe_node(*schema) != expected)
      document_.fail(schema->source(), "schema", describe_node(*schema), expected);
  }

  void read_axes() {
    const toml::node* axes = root_.get("axis");
    if (axes == nullptr && machine_.feed_drive) return;
    if (axes == nullptr || !axes->is_table() || axes->as_table()->empty())
      document_.fail(axes == nullptr ? root_.source() : axes->source(), "axis", "no axis",
                     "at least one table [axis.NAME], or a table [feed_drive]");
    std::vector<std::pair<toml::source_region, AxisModel>> read;
    for (auto&& [name, node] : *axes->as_table()) {
      check_axis_name(name);
      read.emplace_back(name.source(), read_axis(std::string(name.str()), node));
    }
    // toml++ sorts by name; the file's order is that of the user.
    std::stable_sort(read.begin(), read.end(), [](const auto& a, const auto& b) {
      return std::pair(a.first.begin.line, a.first.begin.column) < std::pair(b.first.begin.line, b.first.begin.column);
    });
    for (auto& [place, axis] : read) machine_.axes.push_back(std::move(axis));
  }

  // The name stands before a dot in keys and log columns.
  void check_axis_name(const toml::key& name) const {
    const auto allowed = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    if (name.str().empty() || !std::all_of(name.str().begin(), name.str().end(), allowed))
      document_.fail(name.source(), "axis", fmt::format("the name \"{}\"", name.str()),
                     "a name of letters, digits, _ and -");
  }

  AxisModel read_axis(const std::string& name, const toml::node& node) const {
    const std::string path = join_key("axis", name);
    const toml::table& table = TableReader(document_, false).as_table(node, path, Table<AxisModel>::text);
    const toml::node* model = node_at(table, "motor.model");
    const bool force_motor = model != nullptr && describe_node(*model) == "\"force\"";
    AxisModel axis = TableReader(document_, force_motor, &vocabulary_).read<AxisModel>(table, path);
    axis.name = name;
    check_motor(table, path, axis.motor.model);
    check_friction(table, path, axis.friction);
    check_dead_time(table, path, axis.inverter.dead_time);
    check_notch(table, path, axis.notch);
    check_compensation(document_, table, path, axis, machine_);
    if (runs_ && vocabulary_.check_effects) check_effects(table, path, axis);
    return axis;
  }

  // What the effects say of their values together and beside the friction model in use.
  void check_effects(const toml::table& table, const std::string& path, const AxisModel& axis) const {
    try {
      vocabulary_.check_effects(axis);
    } catch (const ValueError& error) {
      const auto is_named = [&](const Effect& effect) { return effect.name == error.name; };
      const auto last = std::find_if(axis.effects.rbegin(), axis.effects.rend(), is_named);
      const auto index = static_cast<std::size_t>(axis.effects.rend() - last) - 1;
      document_.fail(table.get(effect_key)->as_array()->get(index)->source(),
                     fmt::format("{}[{}]", join_key(path, effect_key), index),
                     fmt::format("{} with {}", error.name, error.found), error.expected);
    }
  }

  void check_motor(const toml::table& table, const std::string& path, MotorModel model) const {
    const auto rule = std::find_if(motor_rules.begin(), motor_rules.end(),
                                   [&](const MotorRule& candidate) { return candidate.model == model; });
    const std::string with = fmt::format("with motor model {}", describe_node(*node_at(table, "motor.model")));
    for (const std::string_view key : rule->needs) {
      const toml::table* nearest = nullptr;
      if (node_at(table, key, &nearest) == nullptr)
        document_.fail(nearest->source(), join_key(path, key), "no such key",
                       fmt::format("{}, {}", expected_at(key), with));
    }
    for (const std::string_view key : rule->excludes)
      if (const toml::node* node = node_at(table, key))
        document_.fail(node->source(), join_key(path, key), describe_node(*node), fmt::format("none {}", with));
  }

  // What the description says of a key or table, by its path from the axis on.
  std::string expected_at(std::string_view path) const {
    for (const TableDescription& table : machine_file_description(vocabulary_)) {
      if (table.name == join_key("axis.NAME", path)) return fmt::format("a table ({})", table.text);
      for (const KeyDescription& key : table.keys)
        if (join_key(table.name, key.key) == join_key("axis.NAME", path)) return key.expected;
    }
    return "a value";
  }

  void check_friction(const toml::table& table, const std::string& path, const FrictionParameters& friction) const {
    const toml::table& friction_table = *node_at(table, "friction")->as_table();
    const std::string friction_path = join_key(path, "friction");
    check_name(friction_table, friction_path, "use", friction.use, friction_model_names(vocabulary_),
               "a friction model");
    if (!friction.models.contains(friction.use))
      document_.fail(friction_table.get("use")->source(), join_key(friction_path, "use"),
                     fmt::format("\"{}\", of which there is no table", friction.use),
                     fmt::format("the table [{}] too, or a model that has one", join_key(friction_path, friction.use)));
  }

  static bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-6; }

  // Refuses a time that is no multiple of `period`, with the multiples on either side in the file's own unit.
  void check_multiple(const toml::table& table, std::string_view path, std::string_view key, double time, double period,
                      std::string_view period_text) const {
    if (is_whole(time / period)) return;
    const toml::table* nearest = nullptr;
    const toml::node* node = node_at(table, key, &nearest);
    const bool given = node != nullptr && node->is_string();
    const std::string unit = given ? std::string(unit_of(node->as_string()->get())) : "s";
    const auto in_unit = [&](double seconds) { return format_quantity(seconds, "s", unit); };
    const double below = std::floor(time / period) * period;
    const std::string fitting =
        below > 0.0 ? fmt::format("{} or {}", in_unit(below), in_unit(below + period)) : in_unit(period);
    document_.fail(given ? node->source() : nearest->source(), join_key(path, key),
                   given ? describe_node(*node) : fmt::format("the default {}", in_unit(time)),
                   fmt::format("a multiple of {}, {}, such as {}", period_text, in_unit(period), fitting));
  }

  void check_periods() const {
    constexpr double nanosecond = 1e-9;  // the drive's clock counts whole nanoseconds
    const Timing& timing = machine_.timing;
    check_multiple(root_, "", "timing.fast_period", timing.fast_period, nanosecond, "a nanosecond");
    check_multiple(root_, "", "timing.slow_period", timing.slow_period, timing.fast_period, "fast_period");
    check_multiple(root_, "", "timing.set_point_delay", timing.set_point_delay, timing.fast_period, "fast_period");
    constexpr auto most = compensation_buffer_ticks - 1;
    if (timing.set_point_delay > (most + 0.5) * timing.fast_period)
      document_.fail(node_at(root_, "timing.set_point_delay")->source(), "timing.set_point_delay",
                     format_quantity(timing.set_point_delay, "s", "us"),
                     fmt::format("at most {}, {} times fast_period: what the drive's buffer of set-points holds",
                                 format_quantity(most * timing.fast_period, "s", "us"), most));
  }

  void check_dead_time(const toml::table& axis, const std::string& path, double dead_time) const {
    // The plant steps four times in a tick.
    check_multiple(axis, path, "inverter.dead_time", dead_time, machine_.timing.fast_period / 4.0,
                   "a quarter of fast_period");
  }

  void check_notch(const toml::table& axis, const std::string& path,
                   const std::optional<NotchParameters>& notch) const {
    const double limit = 0.5 / machine_.timing.fast_period;
    if (!notch || notch->frequency < limit) return;
    const toml::node* node = node_at(axis, "notch.frequency");
    document_.fail(node->source(), join_key(path, "notch.frequency"), describe_node(*node),
                   fmt::format("a frequency below half the fast loop's rate, {}", format_quantity(limit, "Hz", "Hz")));
  }

  // Friction at rest is at least that in motion, and does not fall while the carriage stands.
  void check_feed_drive() const {
    if (!machine_.feed_drive) return;
    const FeedFriction& friction = machine_.feed_drive->friction;
    const toml::table& table = *node_at(root_, "feed_drive.friction")->as_table();
    const auto check = [&](const char* key, double value, const char* lower_key, double lower) {
      if (value >= lower) return;
      const toml::node* node = table.get(key);
      document_.fail(node->source(), join_key("feed_drive.friction", key), describe_node(*node),
                     fmt::format("a number of at least {}, the value of {}", lower, lower_key));
    };
    check("static_short", friction.static_short, "sliding", friction.sliding);
    check("static_long", friction.static_long, "static_short", friction.static_short);
    if (friction.step() <= 0.0)
      document_.fail(table.get("static_long")->source(), "feed_drive.friction.static_long",
                     describe_node(*table.get("static_long")),
                     fmt::format("a number greater than {}, the value of sliding", friction.sliding));
  }

  void check_experiments() const {
    const toml::node* experiments = root_.get("experiment");
    if (experiments == nullptr) return;
    const std::vector<std::string_view> known(experiment_names.begin(), experiment_names.end());
    const TableReader reader(document_, false);
    for (auto&& [name, node] : reader.as_table(*experiments, "experiment", "overrides")) {
      const std::string path = join_key("experiment", name.str());
      if (std::find(known.begin(), known.end(), name.str()) == known.end())
        document_.fail_unknown(name.source(), path, known);
      reader.as_table(node, path, "overrides for one experiment");
    }
  }

  void read_references() {
    const toml::node* references = root_.get("reference");
    if (references == nullptr) return;
    const TableReader reader(document_, false);
    for (auto&& [kind, node] : reader.as_table(*references, "reference", "published or measured rows")) {
      const std::string path = join_key("reference", kind.str());
      if (kind.str() == "circle")
        read_rows(node, path, machine_.circle_references);
      else if (kind.str() == "steady_friction")
        read_rows(node, path, machine_.steady_friction_references);
      else if (kind.str() == "presliding")
        read_rows(node, path, machine_.presliding_references);
      else
        document_.fail_unknown(kind.source(), path, {"circle", "steady_friction", "presliding"});
    }
  }

  template <class Row>
  void read_rows(const toml::node& node, const std::string& path, std::vector<Row>& rows) const {
    if (!node.is_array()) document_.fail(node.source(), path, describe_node(node), fmt::format("rows [[{}]]", path));
    const TableReader reader(document_, false);
    for (const toml::node& row : *node.as_array()) {
      const std::string row_path = fmt::format("{}[{}]", path, rows.size());
      const toml::table& table = reader.as_table(row, row_path, Table<Row>::text);
      rows.push_back(reader.read<Row>(table, row_path));
      std::vector<std::string_view> axes;
      for (const AxisModel& axis : machine_.axes) axes.push_back(axis.name);
      check_name(table, row_path, "axis", rows.back().axis, axes, "an axis of this machine");
      if constexpr (std::is_same_v<Row, CircleReference>) check_source(table, row_path, rows.back());
    }
  }

  // A measured row stands for the machine, a published simulation for one friction model.
  void check_source(const toml::table& table, const std::string& path, const CircleReference& row) const {
    const toml::node* friction = table.get("friction");
    const std::string key = join_key(path, "friction");
    if (row.measured && friction != nullptr)
      document_.fail(friction->source(), key, describe_node(*friction), "none with source \"measured\"");
    if (row.measured) return;
    const auto models = friction_model_names(vocabulary_);
    if (friction == nullptr)
      document_.fail(table.source(), key, "no such key",
                     fmt::format("the friction model of the published simulation: {}", quoted_list(models)));
    check_name(table, path, "friction", *row.friction, models, "a friction model");
  }

  void check_name(const toml::table& table, const std::string& path, std::string_view key, std::string_view name,
                  const std::vector<std::string_view>& known, std::string_view what) const {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    document_.fail(table.get(key)->source(), join_key(path, key), fmt::format("\"{}\"", name),
                   fmt::format("{}: {}{}", what, quoted_list(known), did_you_mean(name, known)));
  }

  const Document& document_;
  const Vocabulary& vocabulary_;
  const toml::table& root_;
  bool runs_;
  Machine machine_;
};

}  // namespace

namespace {

Document document_with(const std::string& file, const std::string& text, const std::string& experiment,
                       std::span<const std::string> set) {
  Document document(file, text);
  document.apply_experiment(experiment);
  for (const std::string& assignment : set) document.apply_set(assignment);
  return document;
}

void mark_expected(Machine& machine, const std::string& file, const std::string& text, const Vocabulary& vocabulary,
                   const ReadOptions& options) {
  if (machine.expected.empty()) return;
  const auto with = [&](const std::string& experiment, std::span<const std::string> set) {
    auto document = document_with(file, text, experiment, set);
    MachineReader(document, vocabulary, experiment == options.experiment).read();
    return document;
  };
  mark_in_force(machine.expected, document_with(file, text, options.experiment, {}),
                document_with(file, text, options.experiment, options.set), options.experiment, with);
}

}  // namespace

std::string content_of(const std::filesystem::path& file) {
  try {
    return read_whole_file(file, fmt::format("a machine file ({})", machine_schema));
  } catch (const UnreadableFile& error) {
    throw MachineFileError(error.what());
  }
}

Machine parse_machine(const std::string& file, const std::string& text, const Vocabulary& vocabulary,
                      const ReadOptions& options) {
  const Document as_it_stands(file, text);
  Machine machine = MachineReader(as_it_stands, vocabulary).read();
  if (const toml::node* experiments = as_it_stands.root().get("experiment")) {
    for (auto&& [name, overrides] : *experiments->as_table()) {
      Document document(file, text);
      document.apply_experiment(name.str());
      const bool runs = name.str() == options.experiment;
      Machine overridden = MachineReader(document, vocabulary, runs).read();
      if (runs) machine = std::move(overridden);
    }
  }
  if (!options.set.empty()) {
    machine = MachineReader(document_with(file, text, options.experiment, options.set), vocabulary).read();
  }
  mark_expected(machine, file, text, vocabulary, options);
  machine.id = std::filesystem::path(file).stem().string();
  return machine;
}

Machine read_machine(const std::filesystem::path& file, const Vocabulary& vocabulary, const ReadOptions& options) {
  return parse_machine(file.string(), content_of(file), vocabulary, options);
}

}  // namespace stiction::machine
