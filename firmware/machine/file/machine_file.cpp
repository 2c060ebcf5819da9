#include "firmware/machine/file/machine_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/machine/configuration/radius.hpp"
#include "firmware/machine/file/axis_coordinates.hpp"
#include "firmware/machine/file/axis_rules.hpp"
#include "firmware/machine/file/compensation_checks.hpp"
#include "firmware/machine/file/document.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/machine/file/endless_turn.hpp"
#include "firmware/machine/file/expected_figures.hpp"
#include "firmware/machine/file/name_check.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/radius_exclusion.hpp"
#include "firmware/machine/file/reference_rows.hpp"
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
    document_.attempt([&] { check_schema(); });
    machine_ = TableReader(document_, false).read<Machine>(root_, "");
    if (!document_.has_errors()) document_.attempt([&] { check_periods(); });
    document_.attempt([&] { read_axes(); });
    document_.report();  // what follows works on values that are right
    check_feed_drive();
    drive_setup_of(document_, machine_);
    document_.report();
    check_experiments();
    read_references(document_, friction_model_names(vocabulary_), machine_);
    document_.report();
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
      document_.attempt([&, &key = name, &axis = node] {
        check_axis_name(key);
        read.emplace_back(key.source(), read_axis(std::string(key.str()), axis));
      });
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
    const bool force_source = model != nullptr && describe_node(*model) == "\"force\"";
    const bool amperes = force_source && driven_by_amperes(table), force_motor = force_source && !amperes;
    const std::size_t errors = document_.errors();
    const auto on_radius = [&](double radius) {
      const auto coordinates = coordinates_of(document_, table, path, radius);
      AxisModel axis = TableReader(document_, force_motor, &vocabulary_, coordinates).read<AxisModel>(table, path);
      axis.motor.amperes = amperes;
      if (axis.controller)
        axis.controller->in_volts =
            coordinates.controller_in_volts || axis.controller->structure == ControlStructure::p_voltage;
      check_alternatives(table, path);
      document_.attempt([&] { reduce(document_, table, path, axis, coordinates); });
      axis.name = name;
      check_motor(table, path, axis);
      const bool values_are_right = document_.errors() == errors;
      check_axis_rules(document_, table, path, axis, errors);
      if (values_are_right) document_.attempt([&] { keep_exactly(document_, table, path, axis); });
      return axis;
    };
    AxisModel axis = on_radius(1.0);
    if (document_.errors() > errors) return axis;  // what follows works on values that are right
    if (axis.coordinate.rotary() && axis.cascaded()) axis = on_its_radius(table, path, std::move(axis), on_radius);
    const auto judge = [&](auto&& check) { document_.attempt(check); };
    judge([&] { check_friction(table, path, "friction", axis.friction); });
    if (axis.motor_friction) judge([&] { check_friction(table, path, "motor_friction", *axis.motor_friction); });
    if (document_.errors() > errors) return axis;
    if (axis.motor_friction && !axis.elastic()) judge([&] { add_motor_friction(document_, table, path, axis); });
    judge([&] { check_controller_period(table, path, axis); });
    judge([&] { check_dead_time(table, path, axis.inverter.dead_time); });
    judge([&] { check_notch(table, path, axis.notch); });
    judge([&] { check_compensation(document_, table, path, axis, machine_); });
    if (runs_ && vocabulary_.check_effects) judge([&] { check_effects(table, path, axis); });
    return axis;
  }

  // An `axis` that was read with a radius of 1 m as `read` gives it with its own; as it is where no radius serves,
  // which it then says.
  template <class Read>
  AxisModel on_its_radius(const toml::table& table, const std::string& path, AxisModel axis, Read&& read) const {
    const auto choice = choose_radius(machine_.timing, axis);
    if (choice.radius) return read(*choice.radius);
    axis.beyond_formats = describe_exclusion(document_, table, path, axis, choice);
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

  void check_alternatives(const toml::table& table, const std::string& path) const {
    for (const auto& [first, second] : alternatives) {
      const toml::table* nearest = nullptr;
      const toml::node *one = node_at(table, first, &nearest), *other = node_at(table, second);
      if (nearest == &table && first.find('.') != std::string_view::npos) continue;  // no such table
      document_.attempt([&, &one_of = first, &in_place = second] {
        if (one == nullptr && other == nullptr)
          document_.fail(nearest->source(), join_key(path, one_of), "no such key",
                         fmt::format("{}, or {}", expected_at(one_of, {}), in_place));
        if (one != nullptr && other != nullptr)
          document_.fail(other->source(), join_key(path, in_place),
                         fmt::format("{} together with {}, {} (line {})", describe_node(*other), one_of,
                                     describe_node(*one), one->source().begin.line),
                         "one of them");
      });
    }
  }

  void check_motor(const toml::table& table, const std::string& path, const AxisModel& axis) const {
    const auto rule = std::find_if(motor_rules.begin(), motor_rules.end(),
                                   [&](const MotorRule& candidate) { return candidate.model == axis.motor.model; });
    const toml::node* model = node_at(table, "motor.model");
    if (model == nullptr) return;
    const std::string with = fmt::format("with motor model {}", describe_node(*model));
    for (const std::string_view key : rule->needs)
      document_.attempt([&] {
        if (key == "current_controller" ? !has_current_loop(axis) : !axis.cascaded() && is_unknown(axis)) return;
        const toml::table* nearest = nullptr;
        if (key == "inverter" && node_at(table, key) == nullptr)
          document_.fail(table.source(), join_key(path, key), "no such table",
                         fmt::format("[{}] ({})", join_key(path, key), Table<InverterParameters>::text));
        if (key.starts_with("inverter.") && node_at(table, "inverter") == nullptr) return;
        const auto own = own_path(key, axis.motor_coordinate);
        if (node_at(table, own, &nearest) == nullptr)
          document_.fail(nearest->source(), join_key(path, own), "no such key",
                         fmt::format("{}, {}", expected_at(key, axis.motor_coordinate), with));
      });
    for (const std::string_view key : rule->excludes)
      if (const toml::node* node = node_at(table, key))
        document_.attempt([&] {
          document_.fail(node->source(), join_key(path, key), describe_node(*node), fmt::format("none {}", with));
        });
  }

  // The path from the axis on of a key that a linear motor's table calls by the last word of `path`.
  static std::string own_path(std::string_view path, const Coordinate& motor) {
    const std::size_t dot = path.rfind('.');
    if (!path.starts_with("motor.") || dot == std::string_view::npos) return std::string(path);
    return join_key(path.substr(0, dot), motor.own(path.substr(dot + 1), "").key);
  }

  // What the description says of a key or table, by its path from the axis on; `motor`: the coordinate of its units.
  std::string expected_at(std::string_view path, const Coordinate& motor) const {
    for (const TableDescription& table : machine_file_description(vocabulary_)) {
      if (table.name == join_key("axis.NAME", path)) return fmt::format("a table ({})", table.text);
      for (const KeyDescription& key : table.keys)
        if (join_key(table.name, key.key) == join_key("axis.NAME", path))
          return motor.rotary() && path.starts_with("motor.") ? key.rotary_expected : key.expected;
    }
    return "a value";
  }

  void check_controller_period(const toml::table& table, const std::string& path, const AxisModel& axis) const {
    if (axis.controller && axis.controller->period)
      check_multiple(table, path, "controller.period", *axis.controller->period, machine_.timing.fast_period,
                     "fast_period");
  }

  void check_friction(const toml::table& table, const std::string& path, std::string_view key,
                      const FrictionParameters& friction) const {
    const toml::table& friction_table = *node_at(table, key)->as_table();
    const std::string friction_path = join_key(path, key);
    check_name(document_, friction_table, friction_path, "use", friction.use, friction_model_names(vocabulary_),
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
  Document as_it_stands(file, text);
  if (options.all_errors) as_it_stands.collect_errors();
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
