// What the reports' pages have in common: see page_data.hpp.
#include "host/report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/report/assets.hpp"
#include "host/report/machine_sheet.hpp"
#include "host/report/page.hpp"

namespace stiction::host {

using json = nlohmann::ordered_json;

double rounded(double value) { return std::stod(fmt::format("{:.10g}", value)); }

void add_once(json& list, const json& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

std::string packed(std::span<const double> values, std::span<const std::size_t> chosen, double scale) {
  std::vector<float> floats;
  floats.reserve(chosen.size());
  for (const std::size_t i : chosen) floats.push_back(static_cast<float>(values[i] * scale));
  return base64_floats(floats);
}

json machine_json(const machine::Machine& machine) {
  json axes = json::array();
  for (const auto& axis : machine.axes) axes.push_back(axis.name);
  json sections = json::array();
  for (const auto& section : machine_sheet(machine)) {
    json rows = json::array();
    for (const auto& row : section.rows)
      rows.push_back({{"label", row.label}, {"unit", row.unit}, {"values", row.values}});
    sections.push_back({{"title", section.title}, {"columns", section.columns}, {"rows", rows}});
  }
  return {{"name", machine.name},
          {"id", machine.id},
          {"fast_period_us", rounded(machine.timing.fast_period * 1e6)},
          {"slow_period_ms", rounded(machine.timing.slow_period * 1e3)},
          {"axes", axes},
          {"sections", sections}};
}

std::string joined(const json& list) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "" : ", ") + item.get<std::string>();
  return text;
}

std::string by_axis(const machine::Machine& machine,
                    const std::function<std::string(const machine::AxisModel&)>& text) {
  json all = json::array(), named = json::array();
  for (const auto& axis : machine.axes) {
    add_once(all, text(axis));
    named.push_back(axis.name + " " + text(axis));
  }
  return joined(all.size() > 1 ? named : all);
}

std::string signals_text(const std::string& signals) {
  if (signals == "fixed") return "fixed-point firmware";
  if (signals == "double") return "double precision";
  return signals;
}

std::string name_and_id(const machine::Machine& machine) { return fmt::format("{} ({})", machine.name, machine.id); }

std::string report_page(const PageFrame& frame, std::string_view body,
                        std::map<std::string, std::string, std::less<>> texts, const json& data,
                        std::initializer_list<std::string_view> scripts) {
  const auto title = escape_html(frame.title), version = escape_html(frame.version);
  texts["opening"] = fill_template(assets::opening_html(),
                                   {{"kind", escape_html(frame.kind)},
                                    {"title", title},
                                    {"sentence", escape_html(frame.sentence)},
                                    {"origin", origin_html(frame.origin, frame.machine, frame.command, frame.version)},
                                    {"abilities", abilities_html(frame.origin)}});
  texts["closing"] = fill_template(assets::closing_html(),
                                   {{"version", version}, {"plotly_license", escape_html(assets::plotly_license())}});
  std::string all_scripts;
  for (const auto script : {assets::page_js(), assets::models_js(), assets::figures_js(), assets::cursors_js(),
                            assets::save_js(), assets::machine_js()})
    all_scripts.append(script).append("\n");
  for (const auto script : scripts) all_scripts.append(script).append("\n");
  return fill_template(assets::frame_html(),
                       {{"title", title},
                        {"version", version},
                        {"scheme", std::string(assets::scheme_js())},
                        {"style", std::string(assets::colours_css()).append(assets::report_css())},
                        {"body", fill_template(body, texts)},
                        {"data", json_for_script(data)},
                        {"plotly", std::string(assets::plotly_js())},
                        {"scripts", all_scripts}});
}

}  // namespace stiction::host
