// The report page of an experiment: see experiment_report.hpp.
#include "host/report/experiment_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/report/assets.hpp"
#include "host/report/chart_json.hpp"
#include "host/report/circle_finding.hpp"
#include "host/report/experiment_finding.hpp"
#include "host/report/experiment_table.hpp"
#include "host/report/machine_sheet.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

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
      if (!series.friction.empty()) add_once(models, friction_label(series.friction));
  Conditions conditions;
  if (!models.empty()) conditions.add("Friction", joined(models));
  if (report.result.signals.empty()) {
    conditions.add("Control", machine.axes.empty() ? "PI loops of the feed drive in continuous time" : "none in use");
    return conditions.json();
  }
  conditions.add("Signals", signals_text(report.result.signals));
  conditions.add("Fast loop", sample_rates({machine.timing.fast_period}));
  conditions.add("Velocity feedback",
                 by_axis(machine, [](const auto& axis) { return velocity_source_name(axis.encoder.velocity); }));
  conditions.add("Motor model", by_axis(machine, [](const auto& axis) { return motor_model_name(axis.motor.model); }));
  return conditions.json();
}

// All charts of one experiment show one record; a frequency response has one an axis: "Velocity loop, Y".
std::string record_of(const sim::ExperimentResult& result, const sim::Chart& chart) {
  if (!chart.logarithmic_x) return result.experiment;
  const auto comma = chart.title.rfind(", ");
  return comma == std::string::npos ? result.experiment : chart.title.substr(comma + 2);
}

std::string list_items(const std::vector<std::string>& sentences) {
  std::string items;
  for (const auto& sentence : sentences) items += "<li>" + escape_html(typeset(sentence)) + "</li>";
  return items;
}

// A simulation's signals are those of the fast loop.
Origin origin_of(const ExperimentReport& report) {
  auto origin = report.origin;
  const auto& signals = report.result.signals;
  if (origin.sample_periods.empty() && (signals == "fixed" || signals == "double"))
    origin.sample_periods.push_back(report.machine.timing.fast_period);
  return origin;
}

}  // namespace

std::string experiment_report_html(const ExperimentReport& report) {
  const auto& result = report.result;
  const auto found = typeset(verdict(result));
  json charts = json::array();
  for (const auto& chart : result.charts) charts.push_back(chart_json(chart, "charts", record_of(result, chart)));
  const json data{
      {"schema", "stiction.experiment-report/1"}, {"verdict", found}, {"conditions", conditions_json(report)},
      {"series", series_json(result.charts)},     {"charts", charts}, {"figures", figures_json(result)},
      {"machine", machine_json(report.machine)}};
  return report_page({"Experiment: " + result.experiment, result.title + ": " + report.machine.name,
                      experiment_sentence(result, report.machine), report.command, report.version,
                      name_and_id(report.machine), origin_of(report)},
                     assets::experiment_html(),
                     {{"question", escape_html(typeset(result.question))}, {"findings", list_items(result.findings)}},
                     data, {assets::charts_js(), assets::experiment_js()});
}

}  // namespace stiction::host
