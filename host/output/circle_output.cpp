#include "host/output/circle_output.hpp"

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "firmware/machine/model/motor_force.hpp"
#include "host/report/circle_table.hpp"

namespace stiction::host {
namespace {

constexpr double per_minute = 60.0;  // m/s to m/min
constexpr double micro = 1e6;        // m to um

const char* name_of(sim::Direction direction) { return direction == sim::Direction::clockwise ? "cw" : "ccw"; }

nlohmann::ordered_json reference_json(const std::optional<double>& error, const std::optional<double>& current) {
  return {{"error_um", *error * micro}, {"current_A", *current}};
}

std::string cell(const std::optional<double>& value, double scale) {
  return value ? fmt::format("{:.1f}", *value * scale) : "-";
}

machine::Effort effort_of(const machine::Machine& machine, const std::string& axis) {
  for (const auto& each : machine.axes)
    if (each.name == axis) return machine::effort_of(each.motor);
  return machine::effort_of({});
}

// "peak current, A", or "peak voltage, V" where the motors are force sources.
std::string effort_heading(const machine::Machine& machine) {
  std::string names;
  for (const auto& axis : machine.axes) {
    const auto effort = machine::effort_of(axis.motor);
    const auto name = fmt::format("{}, {}", effort.name, effort.unit);
    if (names.find(name) == std::string::npos) names += (names.empty() ? "peak " : " or ") + name;
  }
  return names;
}

}  // namespace

nlohmann::ordered_json circle_json(const sim::CircleResult& result, const machine::Machine& machine) {
  nlohmann::ordered_json json{{"schema", "stiction.circle/1"},
                              {"machine", machine.id},
                              {"motion", result.runs.front().is_circle() ? "circle" : "sine"},
                              {"radius_m", result.runs.front().radius},
                              {"signals", result.signals},
                              {"rows", nlohmann::ordered_json::array()},
                              {"circular_errors", nlohmann::ordered_json::array()}};
  for (const auto& row : circle_table(result, machine)) {
    nlohmann::ordered_json r{{"axis", row.axis},
                             {"friction", row.friction},
                             {"feed_m_per_min", row.feed * per_minute},
                             {"direction", name_of(row.direction)},
                             {"peak_error_um", row.error.simulated * micro},
                             {"peak_error_quantised_um", row.error_quantised.simulated * micro}};
    const auto effort = effort_of(machine, row.axis);
    r[fmt::format("peak_{}_{}", effort.name, effort.unit)] = row.current.simulated;
    if (!result.runs.front().is_circle())
      r["frequency_Hz"] = row.feed / (2.0 * std::numbers::pi * result.runs.front().radius);
    if (row.error.published) r["published_simulation"] = reference_json(row.error.published, row.current.published);
    if (row.error.measured) r["measured"] = reference_json(row.error.measured, row.current.measured);
    json["rows"].push_back(std::move(r));
  }
  for (const auto& run : result.runs) {
    if (!run.is_circle()) continue;
    nlohmann::ordered_json r{{"friction", run.friction},
                             {"feed_m_per_min", run.feed * per_minute},
                             {"direction", name_of(run.direction)},
                             {"circular_error_um", run.errors.circular_error * micro},
                             {"radial_error_max_um", run.errors.radial_error_max * micro},
                             {"radial_error_min_um", run.errors.radial_error_min * micro}};
    if (run.both_directions) {
      r["bidirectional_circular_error_um"] = run.both_directions->circular_error * micro;
      r["mean_bidirectional_radial_error_um"] = run.both_directions->mean_radial_error * micro;
    }
    json["circular_errors"].push_back(std::move(r));
  }
  return json;
}

std::string circle_text(const sim::CircleResult& result, const machine::Machine& machine) {
  const auto& first = result.runs.front();
  const auto motion = first.is_circle()
                          ? fmt::format("circle R = {:g} mm", first.radius * 1e3)
                          : fmt::format(
                                "sine of axis {} with the amplitude of a circle of R = {:g} mm and its frequency, "
                                "feed / (2 pi R)",
                                first.axes.front().axis, first.radius * 1e3);
  std::string text = fmt::format(
      "{}, {}, {} signals\n\n"
      "                                        peak error, um                          {}\n"
      "axis friction          feed    dir  simulated quantised published measured  simulated published measured\n"
      "                       m/min\n",
      machine.name, motion, result.signals, effort_heading(machine));
  for (const auto& row : circle_table(result, machine))
    text += fmt::format("{:<4} {:<16} {:>6.4g} {:>5}  {:>9.2f} {:>9.0f} {:>9} {:>8}  {:>9.2f} {:>9} {:>8}\n", row.axis,
                        row.friction, row.feed * per_minute, first.is_circle() ? name_of(row.direction) : "-",
                        row.error.simulated * micro, row.error_quantised.simulated * micro,
                        cell(row.error.published, micro), cell(row.error.measured, micro), row.current.simulated,
                        cell(row.current.published, 1.0), cell(row.current.measured, 1.0));
  if (!first.is_circle()) return text;
  text +=
      "\ncircular errors at the encoder, um (ISO 230-4, Annex E; least-squares centre, no filter)\n"
      "friction          feed    dir   circular G  radial F max  F min    both directions G(b)     D\n"
      "                  m/min\n";
  for (const auto& run : result.runs) {
    text += fmt::format("{:<16} {:>6.4g} {:>5}  {:>11.2f} {:>13.2f} {:>6.2f}", run.friction, run.feed * per_minute,
                        name_of(run.direction), run.errors.circular_error * micro, run.errors.radial_error_max * micro,
                        run.errors.radial_error_min * micro);
    if (run.both_directions)
      text += fmt::format("    {:>20.2f} {:>5.2f}", run.both_directions->circular_error * micro,
                          run.both_directions->mean_radial_error * micro);
    text += '\n';
  }
  return text;
}

}  // namespace stiction::host
