#include "host/identify/identified_machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "firmware/machine/file/extended_machine.hpp"
#include "host/identify/own_identification.hpp"
#include "sim/effects/effect_values.hpp"
#include "sim/effects/load_dependent_friction/load_dependent_friction.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::host {
namespace {

using Value = decltype(machine::MachineEdit::value);

// Keys of friction models and the parameters they are written from.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> parameter_of_key{{
    {"coulomb", "coulomb_N"},
    {"viscous", "viscous_N_s_per_m"},
    {"static_ratio", "static_ratio"},
    {"stiffness", "stiffness_N_per_m"},
    {"damping_ratio", "damping_ratio"},
    {"stribeck_velocity", "stribeck_velocity_m_per_s"},
}};

// A value in the SI `unit` of a linear axis as the file of an axis with this coordinate has it.
Value written(double value, std::string_view unit, const machine::Coordinate& coordinate) {
  if (unit == "1") return value;
  const auto own = coordinate.own(unit);
  return machine::written_quantity(own.from_linear(value), own.unit);
}

std::optional<Value> elements_value(const Identification& result, std::string_view key, std::string_view unit,
                                    const machine::Coordinate& coordinate) {
  if (result.elements.empty()) return std::nullopt;
  const auto own = coordinate.own(unit);
  std::vector<std::string> list;
  for (const auto& element : result.elements)
    list.push_back(
        machine::written_quantity(own.from_linear(key == "stiffness" ? element.stiffness : element.level), own.unit));
  return list;
}

// The value of a model's key; nothing when the data did not determine it.
std::optional<Value> key_value(const Identification& result, std::string_view key, std::string_view unit, bool list,
                               const machine::Coordinate& coordinate) {
  if (list) return key == "stiffness" || key == "level" ? elements_value(result, key, unit, coordinate) : std::nullopt;
  const auto row = std::find_if(parameter_of_key.begin(), parameter_of_key.end(),
                                [&](const auto& candidate) { return candidate.first == key; });
  if (row == parameter_of_key.end()) return std::nullopt;
  const auto* parameter = result.find(row->second);
  if (parameter == nullptr) return std::nullopt;
  // Without a fall of the friction over speed the ratio is 1, and what is above is noise.
  if (key == "static_ratio" && result.find("stribeck_velocity_m_per_s") == nullptr)
    return written(1.0, unit, coordinate);
  return written(std::max(parameter->value, 0.0), unit, coordinate);
}

struct FrictionTable {
  std::string model;
  std::vector<std::pair<std::string, Value>> keys;
  std::vector<std::string> missing;
};

bool is_identified(std::string_view key) {
  return std::any_of(parameter_of_key.begin(), parameter_of_key.end(),
                     [&](const auto& row) { return row.first == key; });
}

template <class Model>
FrictionTable friction_table(const Identification& result, const machine::Coordinate& coordinate) {
  FrictionTable table{std::string(Model::name), {}, {}};
  // A Stribeck velocity acts on nothing while the static ratio is 1: the file's may stay. So may what shapes the
  // contact that was fitted and was taken from the file.
  const bool no_fall = result.find("static_ratio") != nullptr && result.find("stribeck_velocity_m_per_s") == nullptr;
  for (const auto& parameter : Model::parameters) {
    const std::string key(parameter.key);
    const bool list = parameter.member.index() == 3;
    if (const auto value = key_value(result, key, parameter.unit, list, coordinate))
      table.keys.emplace_back(key, *value);
    else if (!(key == "stribeck_velocity" && no_fall) && !(Model::name == result.friction && !is_identified(key)))
      table.missing.push_back(key);
  }
  return table;
}

// The model that acts: the file's own if it is complete, else the most detailed one that is.
std::string model_in_use(const std::string& wanted, const std::vector<std::string>& complete) {
  for (const auto& name : {wanted, std::string(sim::LuGre<>::name)})
    if (std::find(complete.begin(), complete.end(), name) != complete.end()) return name;
  return complete.back();
}

std::string lighter_than_transmission(const Identification& result, const machine::AxisModel& axis, double mass) {
  const auto own = axis.coordinate.own("mass", "kg");
  return fmt::format(
      "{}: found a moving {} of {:.4g} {}; expected more than the {:.4g} {} of motor, transmission and counterweight "
      "that the machine file gives axis {}",
      result.sources.front(), own.key, own.from_linear(mass), own.unit, own.from_linear(axis.mass - axis.load_mass),
      own.unit, axis.name);
}

}  // namespace

std::string identified_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                               const machine::AxisModel& axis, const Identification& result,
                               const std::string& command) {
  std::vector<machine::MachineEdit> edits;
  std::vector<std::string> comment{
      fmt::format("Identified from {}", fmt::join(result.sources, ", ")), fmt::format("by {}", command),
      fmt::format("on the machine file {}; axis {}:", file.filename().string(), axis.name)};
  const auto shown = in_own_units(result, axis);
  for (const auto& p : shown.parameters)
    comment.push_back(
        fmt::format("  {} = {:.6g}, 95 % interval {:.6g} to {:.6g}", p.name, p.value, p.ci95.low, p.ci95.high));
  for (const auto& n : shown.not_determined) comment.push_back(fmt::format("  not determined: {}: {}", n.name, n.why));

  const std::vector<std::string> at{"axis", axis.name};
  const auto path = [&](std::vector<std::string> tail) {
    auto full = at;
    full.insert(full.end(), tail.begin(), tail.end());
    return full;
  };
  const auto whole = axis.coordinate.own("mass", "kg");
  if (const auto* mass = result.find("mass_kg")) {
    // The log tells the whole, the file has the load alone.
    const double load = mass->value - (axis.mass - axis.load_mass);
    if (!(load > 0.0)) throw LogError(lighter_than_transmission(result, axis, mass->value));
    edits.push_back({path({std::string(whole.key)}), written(load, "kg", axis.coordinate)});
    edits.push_back({{"experiment", "*", "axis", axis.name, std::string(whole.key)}, {}});
  } else {
    comment.push_back(
        fmt::format("  {}: kept from the machine file, {:g} {}", whole.key, whole.from_linear(axis.mass), whole.unit));
  }
  if (const auto* gravity = result.find("gravity_moment_N"))
    edits.push_back({path({"gravity", "moment"}),
                     written(gravity->value + axis.gravity->counterweight.value_or(0.0), "N", axis.coordinate)});
  std::vector<machine::MachineEdit> friction{{{"experiment", "*", "axis", axis.name, "friction"}, {}}};
  std::vector<std::string> complete, left;
  sim::for_each_friction_model([&]<class Model>() {
    if (!axis.friction.models.contains(std::string(Model::name))) return;
    const auto table = friction_table<Model>(result, axis.coordinate);
    if (!table.missing.empty()) {
      friction.push_back({path({"friction", table.model}), {}});
      left.push_back(
          fmt::format("  friction.{}: left out, not determined: {}", table.model, fmt::join(table.missing, ", ")));
      return;
    }
    complete.push_back(table.model);
    for (const auto& [key, value] : table.keys) friction.push_back({path({"friction", table.model, key}), value});
  });
  if (complete.empty()) {
    // Data that determine a mass alone still say that.
    comment.push_back("  friction: kept from the machine file, as the data determine no law of it completely");
  } else {
    comment.insert(comment.end(), left.begin(), left.end());
    edits.insert(edits.end(), friction.begin(), friction.end());
    edits.push_back({path({"friction", "use"}), model_in_use(axis.friction.use, complete)});
  }
  // In the place of one that the file has: what was found is the whole.
  std::vector<machine::AxisEffects> additions;
  if (const auto* coefficient = result.find("load_coefficient"))
    additions.push_back(
        {axis.name, {sim::effect_of<sim::LoadDependentFriction>({std::clamp(coefficient->value, 0.0, 0.9)})}});
  return machine::edited_machine(file, sim::vocabulary(), set, edits, additions, comment);
}

}  // namespace stiction::host
