// The report page of an experiment: see experiment_report.hpp.
#include "host/report/experiment_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/report/assets.hpp"
#include "host/report/circle_finding.hpp"
#include "host/report/decimate.hpp"
#include "host/report/experiment_table.hpp"
#include "host/report/machine_sheet.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t points_per_series = 3000;

// Each name of a series once, with the friction model whose colour it takes. `points`: it is nowhere a line.
json series_json(const sim::ExperimentResult& result) {
  json list = json::array();
  for (const auto& chart : result.charts)
    for (const auto& series : chart.series) {
      const auto known =
          std::find_if(list.begin(), list.end(), [&](const json& each) { return each["name"] == series.name; });
      if (known != list.end()) {
        if (!series.points) (*known)["points"] = false;
        continue;
      }
      const auto model = split_model(series.name).friction;
      list.push_back({{"name", series.name},
                      {"label", typeset(series.name)},
                      {"model", model.empty() ? json(nullptr) : json(model)},
                      {"points", series.points}});
    }
  return list;
}

void add_shape(json& out, const sim::Chart& chart) {
  out["levels"] = chart.levels;
  out["distances"] = json::array();
  for (const auto& each : chart.distances)
    out["distances"].push_back({{"x", each.x}, {"from", each.from}, {"to", each.to}, {"label", typeset(each.label)}});
  if (chart.y_range) out["y_range"] = *chart.y_range;
  if (chart.y_step > 0.0) out["y_step"] = chart.y_step;
  using Height = sim::Shape::Height;
  out["wide"] = chart.shape.wide;
  out["height"] = chart.shape.height == Height::usual ? "" : chart.shape.height == Height::low ? "low" : "flat";
}

json chart_json(const sim::Chart& chart) {
  json out{{"title", typeset(chart.title)},
           {"x_label", typeset(chart.x_label)},
           {"y_label", typeset(chart.y_label)},
           {"caption", typeset(chart.caption)},
           {"logarithmic_x", chart.logarithmic_x},
           {"x_range", chart.x_range ? json(*chart.x_range) : json(nullptr)},
           {"series", json::array()}};
  add_shape(out, chart);
  for (const auto& series : chart.series) {
    const auto kept = select_extremes(series.x, series.y, points_per_series);
    out["series"].push_back({{"name", series.name},
                             {"points", series.points},
                             {"bars", series.bars},
                             {"x", packed(series.x, kept)},
                             {"y", packed(series.y, kept)}});
  }
  return out;
}

json figures_json(const sim::ExperimentResult& result) {
  json rows = json::array();
  for (const auto& row : figure_rows(result))
    rows.push_back({{"text", typeset(row.text)},
                    {"friction", row.friction},
                    {"friction_label", friction_label(row.friction)},
                    {"unit", typeset(row.unit)},
                    {"value", row.value},
                    {"expected", row.expected},
                    {"tolerance", row.tolerance},
                    {"source", typeset(row.source)},
                    {"holds", row.holds ? json(*row.holds) : json(nullptr)},
                    {"offset", row.offset ? json(*row.offset) : json(nullptr)}});
  return rows;
}

json conditions_json(const ExperimentReport& report) {
  const auto& machine = report.machine;
  json models = json::array();
  for (const auto& chart : report.result.charts)
    for (const auto& series : chart.series)
      if (const auto model = split_model(series.name).friction; !model.empty()) add_once(models, friction_label(model));
  Conditions conditions;
  if (!models.empty()) conditions.add("Friction", joined(models));
  if (report.result.signals.empty()) {
    conditions.add("Control",
                   machine.axes.empty() ? "the feed drive's own PI loops, in continuous time" : "none takes part");
    return conditions.json();
  }
  conditions.add("Signals", signals_text(report.result.signals));
  conditions.add("Fast loop", fmt::format("{:.5g} kHz ({:.5g} µs)", 1e-3 / machine.timing.fast_period,
                                          machine.timing.fast_period * 1e6));
  conditions.add("Velocity feedback",
                 by_axis(machine, [](const auto& axis) { return velocity_source_name(axis.encoder.velocity); }));
  conditions.add("Motor model", by_axis(machine, [](const auto& axis) { return motor_model_name(axis.motor.model); }));
  return conditions.json();
}

std::string list_items(const std::vector<std::string>& sentences) {
  std::string items;
  for (const auto& sentence : sentences) items += "<li>" + escape_html(typeset(sentence)) + "</li>";
  return items;
}

}  // namespace

std::string experiment_report_html(const ExperimentReport& report) {
  const auto& result = report.result;
  const auto found = typeset(verdict(result));
  json charts = json::array();
  for (const auto& chart : result.charts) charts.push_back(chart_json(chart));
  const json data{{"schema", "stiction.experiment-report/1"},
                  {"verdict", found},
                  {"conditions", conditions_json(report)},
                  {"series", series_json(result)},
                  {"charts", charts},
                  {"figures", figures_json(result)},
                  {"machine", machine_json(report.machine)}};
  return report_page({result.title + ": " + report.machine.name, report.command, report.version},
                     assets::experiment_html(),
                     {{"experiment", escape_html(result.experiment)},
                      {"verdict", escape_html(found)},
                      {"question", escape_html(typeset(result.question))},
                      {"findings", list_items(result.findings)}},
                     data, {assets::experiment_js()});
}

}  // namespace stiction::host
