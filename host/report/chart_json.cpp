#include "host/report/chart_json.hpp"

#include <algorithm>

#include "host/report/decimate.hpp"
#include "host/report/page_data.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t points_per_series = 3000;

void add_shape(json& out, const sim::Chart& chart) {
  out["levels"] = chart.levels;
  out["distances"] = json::array();
  for (const auto& each : chart.distances)
    out["distances"].push_back({{"x", each.x}, {"from", each.from}, {"to", each.to}, {"label", typeset(each.label)}});
  if (chart.y_range) out["y_range"] = *chart.y_range;
  if (chart.y_step > 0.0) out["y_step"] = chart.y_step;
  using Height = sim::Shape::Height;
  out["wide"] = chart.shape.wide;
  if (chart.same_scale) out["same_scale"] = true;
  out["height"] = chart.shape.height == Height::usual ? "" : chart.shape.height == Height::low ? "low" : "flat";
}

const char* role_name(sim::SeriesRole role) {
  switch (role) {
    case sim::SeriesRole::measured:
      return "measured";
    case sim::SeriesRole::before:
      return "before";
    case sim::SeriesRole::after:
      return "after";
    case sim::SeriesRole::other:
      break;
  }
  return "";
}

// A quantity without a unit has the unit one.
std::string with_unit(const std::string& label) {
  return label.find(", ") == std::string::npos ? label + ", 1" : label;
}

}  // namespace

json series_json(const std::vector<sim::Chart>& charts) {
  json list = json::array();
  for (const auto& chart : charts)
    for (const auto& series : chart.series) {
      const auto known =
          std::find_if(list.begin(), list.end(), [&](const json& each) { return each["name"] == series.name; });
      if (known != list.end()) {
        if (!series.points) (*known)["points"] = false;
        continue;
      }
      list.push_back({{"name", series.name},
                      {"label", typeset(series.name)},
                      {"model", series.friction.empty() ? json(nullptr) : json(series.friction)},
                      {"role", role_name(series.role)},
                      {"points", series.points}});
    }
  return list;
}

json chart_json(const sim::Chart& chart, const std::string& place, const std::string& record) {
  json out{{"place", place},
           {"record", record},
           {"title", typeset(chart.title)},
           {"x_label", with_unit(typeset(chart.x_label))},
           {"y_label", with_unit(typeset(chart.y_label))},
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

}  // namespace stiction::host
