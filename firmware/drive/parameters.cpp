#include "firmware/drive/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "sim/machine/drive_parameters.hpp"
#include "sim/machine/parameters.hpp"

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
std::optional<double> value_of(const Owner* owner, const typename sim::Parameter<Owner>::Member& member) {
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
  for (const sim::Parameter<Owner>& p : sim::Table<Owner>::parameters) {
    if (std::holds_alternative<std::vector<double> Owner::*>(p.member)) continue;
    const auto unit = force_motor && !p.unit_of_force_motor.empty() ? p.unit_of_force_motor : p.unit;
    out.push_back({fmt::format("{}.{}", table, p.key), std::string(unit), std::string(p.text), p.range,
                   std::holds_alternative<int Owner::*>(p.member), value_of(owner, p.member)});
  }
}

// A subtable of the axis' table, by the name that it has there.
template <class Member>
void append_subtable(const sim::Axis& axis, Member sim::Axis::*member, std::vector<DriveParameter>& out) {
  using Inner = typename Unwrapped<Member>::type;
  const Inner* owner = nullptr;
  if constexpr (std::is_same_v<Inner, Member>)
    owner = &(axis.*member);
  else if ((axis.*member).has_value())
    owner = &*(axis.*member);
  const auto append_named = [&]<class Other>(const sim::Subtable<sim::Axis, Other>& subtable) {
    if constexpr (std::is_same_v<Other, Member>)
      if (subtable.member == member)
        append_table(owner, fmt::format("axis.{}.{}", axis.name, subtable.key),
                     axis.motor.model == sim::MotorModel::force, out);
  };
  std::apply([&](const auto&... subtables) { (append_named(subtables), ...); }, sim::Table<sim::Axis>::subtables);
}

}  // namespace

std::vector<DriveParameter> drive_parameters(const sim::Machine& machine, const sim::DriveSetup& setup) {
  std::vector<DriveParameter> parameters;
  for (const sim::Axis& axis : machine.axes) {
    append_subtable(axis, &sim::Axis::position_controller, parameters);
    append_subtable(axis, &sim::Axis::velocity_controller, parameters);
    append_subtable(axis, &sim::Axis::current_controller, parameters);
    append_subtable(axis, &sim::Axis::notch, parameters);
    append_subtable(axis, &sim::Axis::feedforward, parameters);
    append_subtable(axis, &sim::Axis::supervision, parameters);
    const auto drive = setup.axes.find(axis.name);
    const std::string table = fmt::format("drive.axis.{}", axis.name);
    const sim::DriveAxisSetup* owner = drive == setup.axes.end() ? nullptr : &drive->second;
    append_table(owner, table, false, parameters);
    append_table(owner == nullptr ? nullptr : &owner->homing, table + ".homing", false, parameters);
  }
  return parameters;
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
