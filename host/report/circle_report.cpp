// The report page of the circular test: see circle_report.hpp. This file turns the result into the data that the page's
// scripts (web/) draw; units are the page's: mm, µm, m/min, A, degrees, s.
#include "host/report/circle_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/motor_force.hpp"
#include "host/report/assets.hpp"
#include "host/report/circle_finding.hpp"
#include "host/report/circle_table.hpp"
#include "host/report/decimate.hpp"
#include "host/report/machine_sheet.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t instants_per_lap = 1500;
constexpr double micro = 1e6;
constexpr double degree = 180.0 / std::numbers::pi;

double m_per_min(double feed) { return rounded(feed * 60.0); }

std::string direction_name(sim::Direction direction) { return direction == sim::Direction::clockwise ? "cw" : "ccw"; }

json optional(const std::optional<double>& value, double scale) { return value ? json(*value * scale) : json(nullptr); }

// ---- runs ----

std::string packed_time(const std::vector<std::size_t>& instants, double period) {
  std::vector<float> values;
  values.reserve(instants.size());
  for (const std::size_t i : instants) values.push_back(static_cast<float>(static_cast<double>(i) * period));
  return base64_floats(values);
}

json run_json(const sim::CircleRun& run) {
  std::vector<std::span<const double>> channels;
  if (run.is_circle()) channels.emplace_back(run.radial_deviation);
  for (const auto& lap : run.axes) channels.emplace_back(lap.error);
  for (const auto& lap : run.axes) channels.emplace_back(lap.current);
  const auto instants = select_instants(run.angle, channels, instants_per_lap);
  json out{{"friction", run.friction},
           {"feed", m_per_min(run.feed)},
           {"direction", direction_name(run.direction)},
           {"radius", rounded(run.radius * 1e3)},
           {"instants", instants.size()},
           {"time", packed_time(instants, run.sample_period)},
           {"angle", packed(run.angle, instants, degree)},
           {"axes", json::array()}};
  if (run.is_circle()) {
    out["radial"] = packed(run.radial_deviation, instants, micro);
    out["G"] = run.errors.circular_error * micro;
    out["F_max"] = run.errors.radial_error_max * micro;
    out["F_min"] = run.errors.radial_error_min * micro;
    out["centre"] = {run.errors.centre[0] * micro, run.errors.centre[1] * micro};
  }
  for (const auto& lap : run.axes)
    out["axes"].push_back({{"error", packed(lap.error, instants, micro)},
                           {"current", packed(lap.current, instants, 1.0)},
                           {"peak_error", lap.peak_error * micro},
                           {"peak_error_quantised", lap.peak_error_quantised * micro},
                           {"peak_current", lap.peak_current}});
  if (run.both_directions) {
    out["G_b"] = run.both_directions->circular_error * micro;
    out["D"] = run.both_directions->mean_radial_error * micro;
  }
  return out;
}

// ---- table, means, references ----

json figure_json(const ComparedFigure& figure, double scale) {
  return {{"simulated", figure.simulated * scale},
          {"published", optional(figure.published, scale)},
          {"measured", optional(figure.measured, scale)},
          {"deviation", optional(figure.deviation(), 100.0)},
          {"differs", figure.differs}};
}

json table_json(const std::vector<CircleTableRow>& table) {
  json rows = json::array();
  for (const auto& row : table)
    rows.push_back({{"axis", row.axis},
                    {"friction", row.friction},
                    {"feed", m_per_min(row.feed)},
                    {"direction", direction_name(row.direction)},
                    {"error", figure_json(row.error, micro)},
                    {"quantised", figure_json(row.error_quantised, micro)},
                    {"current", figure_json(row.current, 1.0)}});
  return rows;
}

json means_json(const std::vector<CircleTableRow>& table) {
  json rows = json::array();
  for (const auto& mean : mean_deviations(table))
    rows.push_back({{"axis", mean.axis},
                    {"friction", mean.friction},
                    {"error", optional(mean.error, 100.0)},
                    {"quantised", optional(mean.error_quantised, 100.0)},
                    {"error_published", optional(mean.error_published, 100.0)},
                    {"current", optional(mean.current, 100.0)},
                    {"current_published", optional(mean.current_published, 100.0)}});
  return rows;
}

json references_json(const machine::Machine& machine) {
  json rows = json::array();
  for (const auto& row : machine.circle_references)
    rows.push_back({{"axis", row.axis},
                    {"measured", row.measured},
                    {"friction", row.friction ? json(*row.friction) : json(nullptr)},
                    {"feed", m_per_min(row.feed)},
                    {"error", row.error * micro},
                    {"current", row.current}});
  return rows;
}

// ---- conditions ----

json conditions_json(const CircleReport& report) {
  const auto& machine = report.machine;
  json radii = json::array(), feeds = json::array(), directions = json::array();
  for (const auto& run : report.result.runs) {
    add_once(radii, fmt::format("{:.6g} mm", run.radius * 1e3));
    add_once(feeds, fmt::format("{:.4g}", run.feed * 60.0));
    add_once(directions, run.direction == sim::Direction::clockwise ? "clockwise" : "counter-clockwise");
  }
  const auto& first = report.result.runs.front();
  Conditions conditions;
  if (first.is_circle()) {
    conditions.add("Plane", first.axes[0].axis + first.axes[1].axis);
    conditions.add("Radius", joined(radii));
    conditions.add("Feeds", joined(feeds) + " m/min");
    conditions.add("Direction", joined(directions));
  } else {
    json frequencies = json::array();
    for (const auto& run : report.result.runs) add_once(frequencies, fmt::format("{:.4g}", run.frequency()));
    conditions.add("Axis", first.axes[0].axis);
    conditions.add("Amplitude", joined(radii));
    conditions.add("Highest speeds", joined(feeds) + " m/min");
    conditions.add("Frequencies", joined(frequencies) + " Hz");
  }
  conditions.add("Signals", signals_text(report.result.signals));
  conditions.add("Velocity feedback",
                 by_axis(machine, [](const auto& a) { return velocity_source_name(a.encoder.velocity); }));
  conditions.add("Motor model", by_axis(machine, [](const auto& a) { return motor_model_name(a.motor.model); }));
  if (first.is_circle()) conditions.add("Circle fit", "least squares");
  conditions.add("Filter", "none");
  return conditions.json();
}

json report_json(const CircleReport& report, const CircleFinding& finding) {
  const auto& runs = report.result.runs;
  json models = json::array(), feeds = json::array(), directions = json::array(), packed_runs = json::array();
  for (const auto& run : runs) {
    add_once(models, {{"name", run.friction}, {"label", friction_label(run.friction)}});
    add_once(feeds, m_per_min(run.feed));
    add_once(directions, direction_name(run.direction));
    packed_runs.push_back(run_json(run));
  }
  std::sort(feeds.begin(), feeds.end());
  json axes = json::array(), efforts = json::array();
  for (const auto& lap : runs.front().axes) {
    axes.push_back(lap.axis);
    const auto own = std::find_if(report.machine.axes.begin(), report.machine.axes.end(),
                                  [&](const auto& axis) { return axis.name == lap.axis; });
    const auto effort = machine::effort_of(own == report.machine.axes.end() ? machine::MotorParameters{} : own->motor);
    efforts.push_back({{"name", effort.name}, {"unit", effort.unit}});
  }
  const auto table = circle_table(report.result, report.machine);
  return {{"schema", "stiction.circle-report/1"},
          {"conditions", conditions_json(report)},
          {"models", models},
          {"feeds", feeds},
          {"directions", directions},
          {"axes", axes},
          {"efforts", efforts},
          {"selected_feed", m_per_min(finding.feed)},
          {"runs", packed_runs},
          {"table", table_json(table)},
          {"means", means_json(table)},
          {"references", references_json(report.machine)},
          {"machine", machine_json(report.machine)}};
}

// What drives the motors, by name; `amperes` is the word for it where it is a current.
std::string effort_words(const CircleReport& report, std::string_view amperes) {
  json words = json::array();
  for (const auto& axis : report.machine.axes) {
    const auto effort = machine::effort_of(axis.motor);
    add_once(words, effort.unit == "A" ? amperes : effort.name);
  }
  return fmt::format("{}", fmt::join(words.get<std::vector<std::string>>(), " or "));
}

Origin origin_of(const CircleReport& report) {
  auto origin = report.origin;
  if (origin.sample_periods.empty())
    for (const auto& run : report.result.runs) origin.sample_periods.push_back(run.sample_period);
  return origin;
}

}  // namespace

std::string circle_report_html(const CircleReport& report) {
  const auto finding = circle_finding(report.result, report.machine);
  const bool circle = report.result.runs.front().is_circle();
  return report_page(
      {circle ? "Circular test" : "Sine of one axis", report.title, finding.sentence, report.command, report.version,
       name_and_id(report.machine), origin_of(report)},
      assets::circle_html(),
      {{"scope",
        circle ? "Circular test using the feedback signal (ISO 230-4 Annex E): shows errors of servo and friction at "
                 "the encoder, never tool-point geometry."
               : "Sine of one axis, with the amplitude and frequency of a circle, using the feedback signal: shows "
                 "errors of servo and friction at the encoder, never tool-point geometry."},
       {"reversal", circle ? "Quadrant" : "Reversal"},
       {"whose", circle ? "both axes" : "the axis"},
       {"effort", effort_words(report, "current")},
       {"efforts", effort_words(report, "current amplitude")}},
      report_json(report, finding),
      {assets::circle_plots_js(), assets::circle_series_js(), assets::circle_tables_js(), assets::circle_js()});
}

}  // namespace stiction::host
