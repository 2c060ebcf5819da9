#include "host/report/identification_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/identify/own_identification.hpp"
#include "host/log/own_units.hpp"
#include "host/report/assets.hpp"
#include "host/report/decimate.hpp"
#include "host/report/engineering_unit.hpp"
#include "host/report/identification_finding.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t rows_per_log = 3000;

// Names of parameters as --json has them, for readers.
struct Label {
  std::string_view name, text, unit;  // SI
};
constexpr std::array<Label, 21> labels{{
    {"gravity_moment_N", "moment of gravity", "N"},
    {"load_coefficient", "friction over the moment of the weight", "1"},
    {"mass_kg", "moving mass", "kg"},
    {"coulomb_N", "Coulomb friction F_C", "N"},
    {"viscous_N_s_per_m", "viscous friction mu_v", "N s/m"},
    {"constant_force_N", "constant force", "N"},
    {"coulomb_positive_N", "Coulomb friction and constant force, +x", "N"},
    {"coulomb_negative_N", "Coulomb friction and constant force, -x", "N"},
    {"viscous_positive_N_s_per_m", "viscous friction, +x", "N s/m"},
    {"viscous_negative_N_s_per_m", "viscous friction, -x", "N s/m"},
    {"stiffness_N_per_m", "contact stiffness k_s", "N/m"},
    {"damping_ratio", "contact damping ratio zeta_s", "1"},
    {"static_ratio", "static over Coulomb friction", "1"},
    {"stribeck_velocity_m_per_s", "Stribeck velocity v_s", "m/s"},
    {"knee_velocity_m_per_s", "speed of the knee", "m/s"},
    {"slope_change_N_s_per_m", "change of the slope there", "N s/m"},
    {"exponential_velocity_m_per_s", "speed of the exponential part", "m/s"},
    {"exponential_force_N", "force of the exponential part", "N"},
    {"exponent", "exponent of the speed", "1"},
    {"force_at_1_m_per_s_N", "force of the power at 1 m/s", "N"},
    {"sliding_curve", "sliding curve", "1"},
}};

constexpr machine::Coordinate any_rotary{machine::AxisKind::rotary, 1.0};

Label label_of(const std::string& name) {
  for (const auto& label : labels) {
    if (label.name == name) return label;
    if (own_name(std::string(label.name)) == name)
      return {name, name == "inertia_kg_m2" ? "moving inertia" : label.text, any_rotary.own(label.unit).unit};
  }
  return {name, name, "1"};
}

json parameter_json(const std::string& name, double value, const Interval& ci, const std::string& how) {
  const auto label = label_of(name);
  const auto unit = engineering_unit(label.unit, std::max({std::abs(value), std::abs(ci.low), std::abs(ci.high)}));
  // As many digits as the interval leaves: two of its half width.
  const double half = 0.5 * (ci.high - ci.low) * unit.factor;
  const int digits = half > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 6) : 3;
  const auto number = [&](double v) { return fmt::format("{:.{}f}", v * unit.factor, digits); };
  return {{"label", label.text},   {"unit", typeset(unit.unit)}, {"value", number(value)},
          {"low", number(ci.low)}, {"high", number(ci.high)},    {"how", typeset(how)}};
}

json curve_json(const Identification& result) {
  if (!result.curve) return nullptr;
  const auto& curve = *result.curve;
  json speed = json::array(), force = json::array(), low = json::array(), high = json::array();
  for (const auto& p : curve.points) {
    speed.push_back(p.speed * 1e3);
    force.push_back(p.force);
    low.push_back(p.low);
    high.push_back(p.high);
  }
  json measured = json::array();
  for (const auto& p : curve.measured) measured.push_back({p.speed * 1e3, p.force, 1.96 * p.standard_error});
  json errors = json::array(), parameters = json::array();
  for (const auto& e : curve.errors) errors.push_back({{"curve", e.curve}, {"rms", fmt::format("{:.3g}", e.held_out)}});
  for (const auto& p : curve.parameters) parameters.push_back(parameter_json(p.name, p.value, p.interval(), ""));
  return {{"curve", curve.curve}, {"speed", speed},       {"force", force},   {"low", low},
          {"high", high},         {"measured", measured}, {"errors", errors}, {"parameters", parameters}};
}

// What each cut-off gives, from the widest on; null where the fit has no choice of it.
json band_json(const Identification& result) {
  if (!result.band) return nullptr;
  const auto& band = *result.band;
  json cutoffs = json::array(), sound = json::array(), charts = json::array();
  for (const auto& p : band.trials) {
    cutoffs.push_back(p.cutoff);
    sound.push_back(p.sound());
  }
  // In the order of BandPoint's columns.
  for (const auto& [name, column] : {std::pair{"mass_kg", std::size_t{0}}, std::pair{"coulomb_N", std::size_t{3}}}) {
    const auto label = label_of(result.rotary ? own_name(name) : name);
    json values = json::array(), halves = json::array();
    for (const auto& p : band.trials) {
      values.push_back(p.value[column]);
      halves.push_back(1.96 * p.error[column]);
    }
    charts.push_back({{"label", label.text}, {"unit", label.unit}, {"value", values}, {"half", halves}});
  }
  return {{"cutoff", cutoffs}, {"sound", sound}, {"chosen", band.chosen}, {"charts", charts}};
}

json residuals_json(const Identification& result) {
  json logs = json::array();
  for (const auto& log : result.residuals) {
    const auto kept = select_extremes(log.time, log.residual, rows_per_log);
    logs.push_back({{"name", log.source},
                    {"time", packed(log.time, kept)},
                    {"speed", packed(log.speed, kept, 1e3)},
                    {"residual", packed(log.residual, kept)}});
  }
  return logs;
}

json initial_json(const InitialValues& initial, bool rotary) {
  const auto own = [&](const char* unit) { return rotary ? any_rotary.own(unit).unit : std::string_view(unit); };
  json rows = json::array();
  const auto add = [&](const char* text, const std::optional<double>& value, const char* unit) {
    if (value) rows.push_back({{"label", text}, {"value", fmt::format("{:.4g}", *value)}, {"unit", own(unit)}});
  };
  add("Coulomb friction, from the steps at reversals", initial.coulomb, "N");
  add("viscous friction, from constant speeds", initial.viscous, "N s/m");
  add(rotary ? "inertia, from acceleration" : "mass, from acceleration", initial.mass, "kg");
  return rows;
}

// What of the records did not count, and what a reader must know of the values.
std::string notes_html(const Identification& result) {
  if (result.notes.empty()) return "";
  std::string items;
  for (const auto& note : result.notes) items += fmt::format("<li>{}</li>", escape_html(typeset(note)));
  return fmt::format("  <ul id=\"notes\">{}</ul>\n", items);
}

Origin origin_of(const IdentificationReport& report) {
  auto origin = report.origin;
  if (origin.sources.empty()) origin.sources = report.result.sources;
  return origin;
}

}  // namespace

std::string identification_report_html(const IdentificationReport& report) {
  const auto& result = report.result;
  json parameters = json::array(), open = json::array();
  for (const auto& p : result.parameters) parameters.push_back(parameter_json(p.name, p.value, p.ci95, p.how));
  for (const auto& n : result.not_determined)
    open.push_back({{"label", label_of(n.name).text}, {"why", typeset(n.why)}, {"record", typeset(n.record)}});
  Conditions conditions;
  conditions.add("Axis", result.axis);
  conditions.add("Samples", fmt::format("{}", result.samples));
  const json data{{"schema", "stiction.identification-report/1"},
                  {"conditions", conditions.json()},
                  {"parameters", parameters},
                  {"open", open},
                  {"band", band_json(result)},
                  {"curve", curve_json(result)},
                  {"residuals", residuals_json(result)},
                  {"initial", initial_json(result.initial, result.rotary)},
                  {"units", {{"force", force_unit(result.rotary)}, {"speed", result.rotary ? "mrad/s" : "mm/s"}}},
                  {"machine", machine_json(report.machine)}};
  const auto axis = std::find_if(report.machine.axes.begin(), report.machine.axes.end(),
                                 [&](const auto& each) { return each.name == result.axis; });
  const auto* file = axis == report.machine.axes.end() ? nullptr : &*axis;
  return report_page({"Identification", "Identification: " + report.machine.name, identification_sentence(result, file),
                      report.command, report.version, name_and_id(report.machine), origin_of(report)},
                     assets::identification_html(),
                     {{"method", escape_html(typeset(result.method))}, {"notes", notes_html(result)}}, data,
                     {assets::identification_js()});
}

}  // namespace stiction::host
