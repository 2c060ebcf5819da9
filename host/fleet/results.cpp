#include "host/fleet/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/sweep/npz.hpp"

namespace stiction::host {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

const FleetRecord& record_of(const FleetResult& result, std::size_t history, std::size_t record) {
  return result.list.records[result.list.axes[history].records[record]];
}

constexpr double normal_limit_of_95 = 1.959964;

Json alarm_json(const FleetResult& result, std::size_t history, const CauseTrend& trend) {
  if (!trend.alarm) return nullptr;
  const auto& alarm = *trend.alarm;
  const auto& record = record_of(result, history, alarm.record);
  const double half = normal_limit_of_95 * alarm.change_error;
  Json json{{"date", record.date},
            {"since", record_of(result, history, alarm.since).date},
            {"records_since", static_cast<std::int64_t>(alarm.record - alarm.since) + 1},
            {"direction", alarm.direction > 0 ? "up" : "down"},
            {"reference", alarm.reference},
            {"sum", alarm.sum},
            {"change", finite_or_null(alarm.change)},
            {"change_low", finite_or_null(alarm.change - half)},
            {"change_high", finite_or_null(alarm.change + half)},
            {"log", record.log},
            {"diagnosis", nullptr}};
  const auto found = result.diagnoses.find(result.list.axes[history].records[alarm.record]);
  if (found != result.diagnoses.end())
    json["diagnosis"] = {{"causes", found->second.causes}, {"message", found->second.message}};
  return json;
}

Json trend_json(const FleetResult& result, std::size_t history, FleetCause cause, const CauseTrend& trend) {
  const bool known = trend.known() && trend.slope_half > 0.0;
  const auto maybe = [&](double value) { return known ? finite_or_null(value) : Json(nullptr); };
  return {{"parameter", cause_name(cause)},
          {"unit", cause_unit(cause, result.model(history))},
          {"records", trend.records.size()},
          {"mean", trend.records.empty() ? Json(nullptr) : finite_or_null(trend.mean)},
          {"scale", trend.scale},
          {"per_month", maybe(trend.slope)},
          {"per_month_low", maybe(trend.slope - trend.slope_half)},
          {"per_month_high", maybe(trend.slope + trend.slope_half)},
          {"relative_per_month", maybe(trend.slope / trend.scale)},
          {"scatter", trend.freedom > 0.0 ? finite_or_null(trend.scatter) : Json(nullptr)},
          {"freedom", finite_or_null(trend.freedom)},
          {"alarm", alarm_json(result, history, trend)}};
}

// One row of the table of estimates.
struct EstimateRow {
  const FleetAxis* axis;
  const FleetRecord* record;
  std::string message, parameter, unit;
  CauseEstimate estimate;
  double deviation = std::numeric_limits<double>::quiet_NaN();
};

std::vector<EstimateRow> rows_of(const FleetResult& result) {
  std::vector<const AxisTrends*> trends(result.list.axes.size());
  for (const auto& axis : result.trends.axes) trends[axis.history] = &axis;
  std::vector<EstimateRow> rows;
  for (std::size_t a = 0; a < result.list.axes.size(); ++a) {
    for (std::size_t k = 0; k < result.list.axes[a].records.size(); ++k) {
      const auto& estimate = result.histories[a].records[k];
      const auto& record = record_of(result, a, k);
      if (!estimate.judged()) {
        rows.push_back({&result.list.axes[a], &record, estimate.message, "", "", {}});
        continue;
      }
      for (std::size_t c = 0; c < fleet_causes; ++c) {
        const auto cause = static_cast<FleetCause>(c);
        EstimateRow row{
            &result.list.axes[a], &record, "", std::string(cause_name(cause)), cause_unit(cause, result.model(a)),
            estimate.causes[c]};
        const auto& own = trends[a]->causes[c];
        const auto at = std::find(own.records.begin(), own.records.end(), k);
        if (at != own.records.end()) row.deviation = own.deviation[static_cast<std::size_t>(at - own.records.begin())];
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return cell + "\"";
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

}  // namespace

Json fleet_json(const FleetResult& result) {
  const auto& trends = result.trends;
  Json json{{"schema", "stiction.fleet/1"},
            {"list", result.list.file},
            {"records", result.list.records.size()},
            {"false_alarms_per_axis_year", trends.false_alarms},
            {"records_per_year", trends.records_a_year},
            {"thresholds", Json::array()},
            {"scatter", Json::array()},
            {"broken", Json::array()},
            {"axes", Json::array()}};
  for (std::size_t r = 0; r < alarm_references.size(); ++r)
    json["thresholds"].push_back({{"reference", alarm_references[r]}, {"threshold", trends.thresholds[r]}});
  for (std::size_t c = 0; c < fleet_causes; ++c)
    json["scatter"].push_back({{"parameter", cause_name(static_cast<FleetCause>(c))},
                               {"between_records", finite_or_null(trends.between[c])},
                               {"common_ratio", finite_or_null(trends.common[c].variance)},
                               {"common_freedom", finite_or_null(trends.common[c].freedom)}});
  for (std::size_t a = 0; a < result.list.axes.size(); ++a)
    for (std::size_t k = 0; k < result.list.axes[a].records.size(); ++k)
      if (const auto& estimate = result.histories[a].records[k]; !estimate.judged())
        json["broken"].push_back({{"axis", result.list.axes[a].name},
                                  {"date", record_of(result, a, k).date},
                                  {"log", record_of(result, a, k).log},
                                  {"message", estimate.message}});
  for (const auto& axis : trends.axes) {
    const auto& own = result.list.axes[axis.history];
    Json parameters = Json::array();
    bool alarmed = false;
    for (std::size_t c = 0; c < fleet_causes; ++c) {
      parameters.push_back(trend_json(result, axis.history, static_cast<FleetCause>(c), axis.causes[c]));
      alarmed = alarmed || axis.causes[c].alarm.has_value();
    }
    Json diagnoses = Json::array();
    for (const auto record : own.records)
      if (const auto found = result.diagnoses.find(record); found != result.diagnoses.end())
        diagnoses.push_back({{"date", result.list.records[record].date},
                             {"causes", found->second.causes},
                             {"message", found->second.message}});
    json["axes"].push_back({{"axis", own.name},
                            {"machine", result.machines[axis.history].id},
                            {"machine_axis", result.model(axis.history).name},
                            {"records", own.records.size()},
                            {"first", result.list.records[own.records.front()].date},
                            {"last", result.list.records[own.records.back()].date},
                            {"alarmed", alarmed},
                            {"parameters", std::move(parameters)},
                            {"diagnoses", std::move(diagnoses)}});
  }
  return json;
}

std::string fleet_csv(const FleetResult& result) {
  std::string text = "axis,machine,date,log,message,parameter,unit,value,standard_error,deviation\n";
  for (const auto& row : rows_of(result))
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", csv_cell(row.axis->name), csv_cell(row.axis->machine),
                        row.record->date, csv_cell(row.record->log), csv_cell(row.message), row.parameter,
                        csv_cell(row.unit), csv_number(row.estimate.value), csv_number(row.estimate.error),
                        csv_number(row.deviation));
  return text;
}

void write_fleet_npz(const FleetResult& result, const std::filesystem::path& place) {
  const auto rows = rows_of(result);
  NpzWriter table(place);
  const auto texts = [&](const std::string& name, auto text) {
    std::size_t longest = 0;
    for (const auto& row : rows) longest = std::max(longest, code_points(text(row)).size());
    table.add_texts(name, rows.size(), longest, [&rows, text](std::uint64_t k) { return std::string(text(rows[k])); });
  };
  const auto numbers = [&](const std::string& name, auto number) {
    table.add_numbers(name, rows.size(), [&rows, number] {
      std::vector<double> values;
      for (const auto& row : rows) values.push_back(number(row));
      return values;
    });
  };
  texts("axis", [](const EstimateRow& row) { return row.axis->name; });
  texts("machine", [](const EstimateRow& row) { return row.axis->machine; });
  texts("date", [](const EstimateRow& row) { return row.record->date; });
  texts("log", [](const EstimateRow& row) { return row.record->log; });
  texts("message", [](const EstimateRow& row) { return row.message; });
  texts("parameter", [](const EstimateRow& row) { return row.parameter; });
  texts("unit", [](const EstimateRow& row) { return row.unit; });
  numbers("value", [](const EstimateRow& row) { return row.estimate.value; });
  numbers("standard_error", [](const EstimateRow& row) { return row.estimate.error; });
  numbers("deviation", [](const EstimateRow& row) { return row.deviation; });
  table.commit();
}

std::string alarm_sentence(const FleetResult& result, std::size_t index, FleetCause cause) {
  const auto& axis = result.trends.axes[index];
  const auto& trend = axis.causes[static_cast<std::size_t>(cause)];
  const auto& alarm = *trend.alarm;
  const auto unit = cause_unit(cause, result.model(axis.history));
  auto text = fmt::format("{}: the {} has changed by {:+.3g} {} ({:+.1f} %) since {}; alarm on {}",
                          result.list.axes[axis.history].name, cause_words(cause), alarm.change, unit,
                          alarm.change / trend.scale * 100.0, record_of(result, axis.history, alarm.since).date,
                          record_of(result, axis.history, alarm.record).date);
  const auto found = result.diagnoses.find(result.list.axes[axis.history].records[alarm.record]);
  if (found != result.diagnoses.end()) {
    const auto& diagnosis = found->second;
    text += !diagnosis.message.empty() ? fmt::format("; it could not be diagnosed: {}", diagnosis.message)
            : diagnosis.causes.empty() ? std::string("; its diagnosis names no cause")
                                       : fmt::format("; its diagnosis names {}", fmt::join(diagnosis.causes, ", "));
  }
  return text + ".";
}

std::string fleet_sentence(const FleetResult& result) {
  const auto alarmed = static_cast<std::size_t>(
      std::count_if(result.trends.axes.begin(), result.trends.axes.end(), [](const AxisTrends& axis) {
        return std::any_of(axis.causes.begin(), axis.causes.end(), [](const CauseTrend& c) { return c.alarm; });
      }));
  return fmt::format("{} of {} axes have an alarm; {:g} false ones are expected of an axis in a year.", alarmed,
                     result.trends.axes.size(), result.trends.false_alarms);
}

}  // namespace stiction::host
