#include "host/report/fleet_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "host/fleet/results.hpp"
#include "host/report/assets.hpp"
#include "host/report/page.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

constexpr double normal_limit = 1.959964;  // of 95 %, both sides

// Months from `first`, relative values with half of their intervals, and the trend where there is one.
json course_json(const AxisHistory& history, FleetCause cause, const CauseTrend& trend, double first) {
  json months = json::array(), values = json::array(), halves = json::array();
  for (const auto record : trend.records) {
    const auto& estimate = history.records[record].causes[static_cast<std::size_t>(cause)];
    months.push_back(rounded((history.days[record] - first) / days_of_month));
    values.push_back(rounded(estimate.value));
    halves.push_back(rounded(normal_limit * estimate.error));
  }
  json course{{"months", std::move(months)},
              {"values", std::move(values)},
              {"halves", std::move(halves)},
              {"scale", rounded(trend.scale)},
              {"trend", nullptr},
              {"alarm", nullptr}};
  if (trend.slope_half > 0.0)
    course["trend"] = {{"mean", rounded(trend.mean)},
                       {"month", rounded((trend.day - first) / days_of_month)},
                       {"slope", rounded(trend.slope)},
                       {"half", rounded(trend.slope_half)},
                       {"mean_half", rounded(trend.limit * trend.mean_error)}};
  if (trend.alarm)
    course["alarm"] = {{"month", rounded((history.days[trend.alarm->record] - first) / days_of_month)},
                       {"since", rounded((history.days[trend.alarm->since] - first) / days_of_month)},
                       {"direction", trend.alarm->direction}};
  return course;
}

json axes_json(const FleetResult& result, double first) {
  json axes = json::array();
  for (std::size_t a = 0; a < result.trends.axes.size(); ++a) {
    const auto& axis = result.trends.axes[a];
    const auto& history = result.histories[axis.history];
    json courses = json::array(), alarms = json::array();
    for (std::size_t c = 0; c < fleet_causes; ++c) {
      const auto cause = static_cast<FleetCause>(c);
      auto course = course_json(history, cause, axis.causes[c], first);
      course["unit"] = typeset(cause_unit(cause, result.model(axis.history)));
      courses.push_back(std::move(course));
      if (axis.causes[c].alarm) alarms.push_back(typeset(alarm_sentence(result, a, cause)));
    }
    axes.push_back({{"axis", history.name},
                    {"machine", result.machines[axis.history].id},
                    {"records", history.records.size()},
                    {"alarms", std::move(alarms)},
                    {"courses", std::move(courses)}});
  }
  return axes;
}

std::string items_of(const std::vector<std::string>& sentences) {
  std::string items;
  for (const auto& sentence : sentences) items += "<li>" + escape_html(typeset(sentence)) + "</li>";
  return items;
}

std::vector<std::string> findings_of(const FleetResult& result) {
  std::vector<std::string> findings;
  for (std::size_t a = 0; a < result.trends.axes.size(); ++a)
    for (std::size_t c = 0; c < fleet_causes; ++c)
      if (result.trends.axes[a].causes[c].alarm)
        findings.push_back(alarm_sentence(result, a, static_cast<FleetCause>(c)));
  std::size_t broken = 0;
  for (const auto& history : result.histories)
    for (const auto& record : history.records) broken += !record.judged();
  findings.push_back(
      fmt::format("{} records of {} were judged.", result.list.records.size() - broken, result.list.records.size()));
  return findings;
}

json broken_json(const FleetResult& result) {
  json broken = json::array();
  for (std::size_t a = 0; a < result.histories.size(); ++a)
    for (std::size_t k = 0; k < result.histories[a].records.size(); ++k)
      if (const auto& estimate = result.histories[a].records[k]; !estimate.judged())
        broken.push_back({{"axis", result.histories[a].name},
                          {"date", result.list.records[result.list.axes[a].records[k]].date},
                          {"message", typeset(estimate.message)}});
  return broken;
}

}  // namespace

std::string fleet_report_html(const FleetReport& report) {
  const auto& result = report.result;
  double first = result.list.records.front().day, last = first;
  std::string first_date = result.list.records.front().date;
  for (const auto& record : result.list.records) {
    if (record.day < first) first_date = record.date;
    first = std::min(first, record.day);
    last = std::max(last, record.day);
  }
  json causes = json::array();
  for (std::size_t c = 0; c < fleet_causes; ++c)
    causes.push_back(
        {{"words", cause_words(static_cast<FleetCause>(c))}, {"between", rounded(result.trends.between[c])}});
  Origin origin;
  std::set<std::string> files;
  for (const auto& axis : result.list.axes) files.insert(axis.file.string());
  origin.machine_files.assign(files.begin(), files.end());
  origin.sources.push_back(result.list.file);
  const json data{{"schema", "stiction.fleet-report/1"},
                  {"first", first_date},
                  {"months", rounded((last - first) / days_of_month)},
                  {"false_alarms", result.trends.false_alarms},
                  {"causes", std::move(causes)},
                  {"axes", axes_json(result, first)},
                  {"broken", broken_json(result)}};
  return report_page(
      {"Fleet", fmt::format("Fleet: {} axes", result.list.axes.size()), typeset(fleet_sentence(result)), report.command,
       report.version, fmt::format("{} machine file{}", files.size(), files.size() == 1 ? "" : "s"), origin},
      assets::fleet_html(), {{"findings", items_of(findings_of(result))}}, data, {assets::fleet_js()});
}

}  // namespace stiction::host
