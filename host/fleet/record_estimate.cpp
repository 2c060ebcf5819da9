#include "host/fleet/record_estimate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/diagnose/diagnose.hpp"
#include "host/identify/law_choice.hpp"
#include "host/identify/own_identification.hpp"
#include "host/log/read_log.hpp"
#include "host/log/stretches.hpp"

namespace stiction::host {
namespace {

struct CauseRow {
  std::string_view name, words, parameter, unit;  // the latter two of a linear axis
};
constexpr std::array<CauseRow, fleet_causes> cause_rows{{
    {"mass", "moving mass", "mass_kg", "kg"},
    {"constant_force", "constant force", "constant_force_N", "N"},
    {"coulomb", "Coulomb friction", "coulomb_N", "N"},
    {"viscous", "viscous friction", "viscous_N_s_per_m", "N s/m"},
}};
const CauseRow& row_of(FleetCause cause) { return cause_rows[static_cast<std::size_t>(cause)]; }

constexpr double normal_limit = 1.959964;  // of 95 %, both sides

// A workpiece seldom doubles the moving mass; a log of a different machine often does.
constexpr double most_mass_ratio = 2.0;

std::vector<Log> logs_of(const machine::Machine& machine, const std::filesystem::path& file) {
  auto log = read_log(file.string());
  for (const auto& [key, value] : log.comments)
    if (key == "machine" && value != machine.id && value != machine.name)  // our own logs have the name
      throw LogError(fmt::format("{}: found a log of the machine {}; expected one of {} ({})", file.string(), value,
                                 machine.id, machine.name));
  return stretches_of(std::move(log));
}

void require_own_mass(const CauseEstimate& mass, const machine::AxisModel& axis, const std::filesystem::path& file) {
  const double expected = axis.coordinate.own("kg").from_linear(axis.mass);
  if (!std::isfinite(mass.value) || expected <= 0.0) return;
  if (mass.value < expected * most_mass_ratio && mass.value * most_mass_ratio > expected) return;
  const auto unit = cause_unit(FleetCause::mass, axis);
  throw LogError(fmt::format(
      "{}: found a moving mass of {:.4g} {}; expected {:.4g} {} as in the machine file, within a factor of {:g} (is it "
      "a log of a different machine?)",
      file.string(), mass.value, unit, expected, unit, most_mass_ratio));
}

}  // namespace

std::string_view cause_name(FleetCause cause) { return row_of(cause).name; }
std::string_view cause_words(FleetCause cause) { return row_of(cause).words; }
std::string cause_unit(FleetCause cause, const machine::AxisModel& axis) {
  return std::string(axis.coordinate.own(row_of(cause).unit).unit);
}

RecordEstimate estimate_record(const machine::Machine& machine, std::size_t index, const std::filesystem::path& file) {
  RecordEstimate estimate;
  try {
    const auto& axis = machine.axes.at(index);
    IdentifyOptions options;
    options.friction = usual_law(axis);
    options.moving_rows_only = true;
    const auto result = in_own_units(identify_logs(linear_logs(logs_of(machine, file), axis), axis, options), axis);
    bool any = false;
    for (std::size_t k = 0; k < fleet_causes; ++k) {
      const std::string name(cause_rows[k].parameter);
      const auto* found = result.find(axis.coordinate.rotary() ? own_name(name) : name);
      if (found == nullptr) continue;
      estimate.causes[k] = {found->value, (found->ci95.high - found->ci95.low) / (2.0 * normal_limit)};
      any = true;
    }
    if (!any)
      throw LogError(
          fmt::format("{}: found a record that determines neither mass nor friction; expected one in which "
                      "axis {} moves at several speeds in both directions",
                      file.string(), axis.name));
    require_own_mass(estimate.causes[static_cast<std::size_t>(FleetCause::mass)], axis, file);
  } catch (const std::exception& error) {
    estimate = {};
    estimate.message = error.what();
  }
  return estimate;
}

std::vector<std::string> diagnose_record(const machine::Machine& machine, std::size_t axis,
                                         const std::filesystem::path& file) {
  DiagnoseInput input;
  input.machine = machine;
  input.logs = logs_of(machine, file);
  input.axis = axis;
  input.next_measurement = false;  // changes nothing of the findings
  std::vector<std::string> names;
  for (const auto& finding : diagnose(input).findings)
    names.push_back(fmt::format("{} {:.2f}", finding.effect.name(), finding.explains));
  return names;
}

}  // namespace stiction::host
