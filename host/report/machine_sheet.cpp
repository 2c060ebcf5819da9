// A machine's parameters as a report prints them: see machine_sheet.hpp.
#include "host/report/machine_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "firmware/machine/file/parameters.hpp"
#include "firmware/machine/model/own_words.hpp"
#include "firmware/machine/model/value_table.hpp"
#include "host/report/engineering_unit.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::host {
namespace {

// One axis' value of a parameter, before its unit is chosen.
struct Cell {
  std::string label;           // of the row, in the axis' own words
  std::string_view unit;       // SI
  std::vector<double> values;  // none: not given
  std::string instead;         // what stands there without a value, or in place of one that has a name
};

// A parameter's text is "LABEL", "LABEL; left out: MEANING" or "LABEL; NUMBER: MEANING".
std::string label_of(std::string_view text) { return std::string(text.substr(0, text.find(';'))); }

std::string meaning_of(std::string_view text, std::optional<double> value) {
  const auto semicolon = text.find("; "), colon = text.find(": ", semicolon);
  if (semicolon == std::string_view::npos || colon == std::string_view::npos) return {};
  const std::string when(text.substr(semicolon + 2, colon - semicolon - 2));
  char* end = nullptr;
  const double number = std::strtod(when.c_str(), &end);
  const bool names_number = end != when.c_str() && *end == '\0';
  const bool applies = value ? names_number && number == *value : when == "left out";
  return applies ? std::string(text.substr(colon + 2)) : std::string();
}

// Whose units the values of a column have.
struct Column {
  bool force_motor = false;
  machine::Coordinate axis{}, motor{};
};

// `values` of `key`, in units of `coordinate`: what its range refuses is the default of a key that this motor does not
// need.
Cell make_cell(const machine::ValueKey& key, std::vector<double> values, const Column& column,
               const machine::Coordinate& coordinate) {
  const auto own = coordinate.own(
      key.key, column.force_motor && !key.unit_of_force_motor.empty() ? key.unit_of_force_motor : key.unit);
  for (double& value : values) value = own.from_linear(value);
  if (!std::all_of(values.begin(), values.end(), [&](double v) { return key.range.contains(v); })) values.clear();
  const auto text = machine::in_own_words(key.text, coordinate);
  // A rate of a rotary axis is no K_v of metres a minute.
  const auto unit = own.unit == "1/s" && coordinate.rotary() ? "(rad/s)/rad" : own.unit;
  Cell cell{label_of(text), unit, std::move(values), {}};
  if (cell.values.size() <= 1)
    cell.instead = meaning_of(text, cell.values.empty() ? std::nullopt : std::optional(cell.values[0]));
  if (cell.values.size() == 1 && cell.values[0] >= machine::unlimited) cell.instead = "none";
  return cell;
}

std::string print(const Cell& cell, double factor) {
  if (!cell.instead.empty()) return cell.instead;
  std::string list;  // six digits show every figure of a machine file and no digit of a conversion; counts are whole
  for (const double value : cell.values) {
    const bool count = cell.unit == "1" && value == std::round(value) && std::abs(value) < 1e15;
    list += count ? fmt::format("{}{:.0f}", list.empty() ? "" : ", ", value)
                  : fmt::format("{}{:.6g}", list.empty() ? "" : ", ", value * factor);
  }
  return list;
}

class Sheet {
 public:
  // `columns`: what the values are of, in the order of the cells.
  explicit Sheet(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  void begin_section(std::string title) { sections_.push_back({std::move(title), columns_, {}}); }

  void add(std::string label, std::string unit, std::vector<std::string> values) {
    if (std::all_of(values.begin(), values.end(), [](const auto& value) { return value.empty(); })) return;
    sections_.back().rows.push_back({std::move(label), std::move(unit), std::move(values)});
  }

  // One cell an axis, none where the axis lacks the table. Axes that give the parameter different units or call it
  // differently come in different rows.
  void add(const std::vector<std::optional<Cell>>& cells) {
    std::vector<const Cell*> rows;
    for (const auto& cell : cells)
      if (cell && std::none_of(rows.begin(), rows.end(), [&](const Cell* row) { return in_one_row(*row, *cell); }))
        rows.push_back(&*cell);
    for (const Cell* row : rows) add_row(*row, cells);
  }

  std::vector<SheetSection> take() {
    std::erase_if(sections_, [](const auto& section) { return section.rows.empty(); });
    return std::move(sections_);
  }

 private:
  static bool in_one_row(const Cell& a, const Cell& b) { return a.unit == b.unit && a.label == b.label; }

  // `first`: of the row.
  void add_row(const Cell& first, const std::vector<std::optional<Cell>>& cells) {
    double size = 0.0;
    bool numbers = false;
    for (const auto& cell : cells)
      if (cell && in_one_row(*cell, first) && cell->instead.empty())
        for (const double value : cell->values) {
          size = std::max(size, std::abs(value));
          numbers = true;
        }
    const auto engineering = engineering_unit(first.unit, size);
    std::vector<std::string> values;
    for (const auto& cell : cells)
      values.push_back(cell && in_one_row(*cell, first) ? print(*cell, engineering.factor) : std::string());
    add(first.label, numbers ? engineering.unit : std::string(), std::move(values));
  }

  std::vector<std::string> columns_;
  std::vector<SheetSection> sections_;
};

std::string title_of(std::string_view key) {
  std::string title(key);
  std::replace(title.begin(), title.end(), '_', ' ');
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return title;
}

template <class Value>
std::string name_of(std::span<const machine::Choice<Value>> choices, const Value& value) {
  for (const auto& choice : choices)
    if (choice.value == value) return std::string(choice.name);
  return "?";
}

template <class T>
const T* pointer_to(const T& value) {
  return &value;
}
template <class T>
const T* pointer_to(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

// The coordinate in which a column gives the values of a table.
template <class Owner>
machine::Coordinate coordinate_in(const Column& column) {
  return std::is_same_v<Owner, machine::MotorParameters> ? column.motor : column.axis;
}

// `described`: of each owner.
template <class Owner>
void add_parameters(Sheet& sheet, std::span<const machine::Parameter<Owner>> parameters,
                    const std::vector<const Owner*>& owners, const std::vector<Column>& described) {
  for (const auto& parameter : parameters) {
    const auto key = machine::key_of(parameter);
    std::vector<std::optional<Cell>> cells;
    for (std::size_t i = 0; i < owners.size(); ++i)
      cells.push_back(owners[i] ? std::optional(make_cell(key, machine::values_at(place_of(parameter, *owners[i])),
                                                          described[i], coordinate_in<Owner>(described[i])))
                                : std::nullopt);
    sheet.add(cells);
  }
}

// One table of the machine file and the tables in it; a null owner: this axis has no such table.
template <class Owner>
void add_table(Sheet& sheet, const std::string& title, const std::vector<const Owner*>& owners,
               const std::vector<Column>& described) {
  using T = machine::Table<Owner>;
  sheet.begin_section(title);
  const auto add_words = [&](std::string_view label, const auto& word) {
    std::vector<std::string> values;
    for (const Owner* owner : owners) values.push_back(owner ? word(*owner) : std::string());
    sheet.add(label_of(label), "", std::move(values));
  };
  std::apply(
      [&](const auto&... p) {
        (add_words(p.text, [&](const Owner& owner) { return name_of(p.choices, owner.*p.member); }), ...);
      },
      T::choices);
  add_parameters<Owner>(sheet, T::parameters, owners, described);
  const auto descend = [&]<class Member>(const machine::Subtable<Owner, Member>& subtable) {
    using Child = std::remove_cvref_t<decltype(*pointer_to(std::declval<const Member&>()))>;
    if constexpr (!std::is_base_of_v<machine::FrictionParameters, Child>) {  // its tables are those of the models
      std::vector<const Child*> children;
      for (const Owner* owner : owners) children.push_back(owner ? pointer_to(owner->*subtable.member) : nullptr);
      const bool top = std::is_same_v<Owner, machine::AxisModel> || std::is_same_v<Owner, machine::FeedDrive>;
      add_table<Child>(sheet, top ? title_of(subtable.key) : title + " " + std::string(subtable.key), children,
                       described);
    }
  };
  std::apply([&](const auto&... subtable) { (descend(subtable), ...); }, T::subtables);
}

void add_friction(Sheet& sheet, std::span<const machine::AxisModel> axes, const std::vector<Column>& described) {
  sim::for_each_friction_model([&]<class Model>() {
    using Parameters = typename Model::Parameters;
    std::vector<std::optional<Parameters>> given(axes.size());
    std::vector<const Parameters*> owners;
    std::vector<std::string> acting;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const auto& axis = axes[k];
      const auto found = axis.friction.models.find(std::string(Model::name));
      if (found != axis.friction.models.end()) given[k] = sim::parameters_of<Model>(found->second);
      owners.push_back(given[k] ? &*given[k] : nullptr);
      acting.push_back(axis.friction.use == Model::name ? "yes" : "");
    }
    sheet.begin_section("Friction " + std::string(Model::label));
    sheet.add("active unless a command names a different model", "", std::move(acting));
    add_parameters<Parameters>(sheet, Model::parameters, owners, described);
  });
}

std::string turn_label(machine::EncoderPlace place) {
  return fmt::format("counts of the {} encoder a turn", place == machine::EncoderPlace::motor ? "motor's" : "load's");
}

// What the file does not say in one place: what the load is of the whole, and on which radius a rotary axis runs.
void add_reduction(Sheet& sheet, std::span<const machine::AxisModel> axes) {
  sheet.begin_section("Reduction to the axis");
  constexpr std::string_view mass = "kg";
  std::vector<std::optional<Cell>> load, radius;
  for (const auto& axis : axes) {
    const auto own = axis.coordinate.own(mass);
    const auto cell = [&](bool wanted, std::string label, std::string_view unit, double value) {
      return wanted ? std::optional(Cell{std::move(label), unit, {value}, {}}) : std::nullopt;
    };
    load.push_back(cell(axis.transmission.has_value(),
                        machine::in_own_words("of the moving mass, load alone", axis.coordinate), own.unit,
                        own.from_linear(axis.load_mass)));
    radius.push_back(cell(axis.coordinate.rotary() && axis.beyond_formats.empty(),
                          "way of a radian in the drive's numbers", "m/rad", axis.coordinate.radius));
  }
  sheet.add(load);
  sheet.add(radius);
  for (const auto place : {machine::EncoderPlace::motor, machine::EncoderPlace::load}) {
    std::vector<std::string> counts;
    for (const auto& axis : axes)
      counts.push_back(axis.modulo_counts && axis.encoder.on == place ? machine::text_of(*axis.modulo_counts) : "");
    sheet.add(turn_label(place), "", std::move(counts));
  }
}

}  // namespace

std::string motor_model_name(machine::MotorModel model) {
  return name_of<machine::MotorModel>(machine::motor_models, model);
}

std::string velocity_source_name(machine::VelocitySource source) {
  return name_of<machine::VelocitySource>(machine::velocity_sources, source);
}

std::vector<SheetSection> machine_sheet(const machine::Machine& machine) {
  std::vector<std::string> names;
  std::vector<const machine::AxisModel*> axes;
  std::vector<Column> described;
  for (const auto& axis : machine.axes) {
    names.push_back(axis.name);
    axes.push_back(&axis);
    described.push_back({axis.motor.driven_by_volts(), axis.coordinate, axis.motor_coordinate});
  }
  Sheet sheet(names);
  add_table<machine::AxisModel>(sheet, "Axis", axes, described);
  add_friction(sheet, machine.axes, described);
  add_reduction(sheet, machine.axes);
  auto sections = sheet.take();
  if (machine.feed_drive) {
    Sheet feed({"feed drive"});
    add_table<machine::FeedDrive>(feed, "Feed drive", {&*machine.feed_drive}, {Column{}});
    for (auto& section : feed.take()) sections.push_back(std::move(section));
  }
  return sections;
}

}  // namespace stiction::host
