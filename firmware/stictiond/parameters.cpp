#include "firmware/stictiond/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "firmware/machine/file/drive_parameters.hpp"
#include "firmware/machine/file/parameters.hpp"

namespace stiction::drive {
namespace {

template <class T>
struct Unwrapped {
  using type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using type = T;
};

template <class Owner>
std::optional<double> value_of(const Owner* owner, const typename machine::Parameter<Owner>::Member& member) {
  if (owner == nullptr) return {};
  return std::visit(
      [&]<class Value>(Value Owner::*at) -> std::optional<double> {
        if constexpr (std::is_same_v<Value, std::vector<double>>)
          return {};
        else
          return owner->*at;
      },
      member);
}

// The numeric keys of one table; `owner` is null where the file leaves the table out.
template <class Owner>
void append_table(const Owner* owner, const std::string& table, bool force_motor, std::vector<DriveParameter>& out) {
  for (const machine::Parameter<Owner>& p : machine::Table<Owner>::parameters) {
    if (std::holds_alternative<std::vector<double> Owner::*>(p.member)) continue;
    const auto unit = force_motor && !p.unit_of_force_motor.empty() ? p.unit_of_force_motor : p.unit;
    out.push_back({fmt::format("{}.{}", table, p.key), std::string(unit), std::string(p.text), p.range,
                   std::holds_alternative<int Owner::*>(p.member), value_of(owner, p.member)});
  }
}

// A subtable of the axis' table, by the name that it has there.
template <class Member>
void append_subtable(const machine::AxisModel& axis, Member machine::AxisModel::*member,
                     std::vector<DriveParameter>& out) {
  using Inner = typename Unwrapped<Member>::type;
  const Inner* owner = nullptr;
  if constexpr (std::is_same_v<Inner, Member>)
    owner = &(axis.*member);
  else if ((axis.*member).has_value())
    owner = &*(axis.*member);
  const auto append_named = [&]<class Other>(const machine::Subtable<machine::AxisModel, Other>& subtable) {
    if constexpr (std::is_same_v<Other, Member>)
      if (subtable.member == member)
        append_table(owner, fmt::format("axis.{}.{}", axis.name, subtable.key), axis.motor.driven_by_volts(), out);
  };
  std::apply([&](const auto&... subtables) { (append_named(subtables), ...); },
             machine::Table<machine::AxisModel>::subtables);
}

}  // namespace

std::vector<DriveParameter> drive_parameters(const machine::Machine& machine, const machine::DriveSetup& setup) {
  std::vector<DriveParameter> parameters;
  for (const machine::AxisModel& axis : machine.axes) {
    append_subtable(axis, &machine::AxisModel::position_controller, parameters);
    append_subtable(axis, &machine::AxisModel::velocity_controller, parameters);
    append_subtable(axis, &machine::AxisModel::current_controller, parameters);
    append_subtable(axis, &machine::AxisModel::notch, parameters);
    append_subtable(axis, &machine::AxisModel::feedforward, parameters);
    append_subtable(axis, &machine::AxisModel::supervision, parameters);
    const auto drive = setup.axes.find(axis.name);
    const std::string table = fmt::format("drive.axis.{}", axis.name);
    const machine::DriveAxisSetup* owner = drive == setup.axes.end() ? nullptr : &drive->second;
    append_table(owner, table, false, parameters);
    append_table(owner == nullptr ? nullptr : &owner->homing, table + ".homing", false, parameters);
    append_table(owner == nullptr ? nullptr : &owner->cam, table + ".cam", false, parameters);
  }
  return parameters;
}

std::string rejection_of(const DriveParameter& parameter, double value) {
  for (const auto& limit : limit_parameters) {
    if (!parameter.key.ends_with("." + std::string(limit.key))) continue;
    if (!parameter.value)
      return fmt::format(
          "{}: found {:g} {}; expected a value in the machine file first: a limit that has none there cannot be judged",
          parameter.key, value, parameter.unit);
    const bool down = limit.tightens == Tightens::down;
    if (down ? value <= *parameter.value : value >= *parameter.value) return {};
    return fmt::format(
        "{}: found {:g} {}; expected at {} {:g} {}, the limit in force: over a bus limits are only made tighter. "
        "Change "
        "the machine file to loosen it",
        parameter.key, value, parameter.unit, down ? "most" : "least", *parameter.value, parameter.unit);
  }
  return {};
}

std::vector<std::string> assignments_of(const ParameterSet& set, const std::string& machine_id,
                                        const std::vector<DriveParameter>& parameters) {
  if (set.machine != machine_id)
    throw std::runtime_error(
        fmt::format("parameters: found those of the machine {}; expected those of {}", set.machine, machine_id));
  std::vector<std::string> assignments;
  for (const auto& [key, value] : set.values) {
    const auto found =
        std::find_if(parameters.begin(), parameters.end(), [&name = key](const auto& p) { return p.key == name; });
    if (found == parameters.end())
      throw std::runtime_error(fmt::format("parameters: found {}; expected a parameter of this machine", key));
    assignments.push_back(found->unit == "1" ? fmt::format("{}={}", key, value)
                                             : fmt::format("{}={} {}", key, value, found->unit));
  }
  return assignments;
}

}  // namespace stiction::drive
