#include "host/simulate/stand_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/cam/characteristics.hpp"

namespace stiction::host {
namespace {

using sim::cam::LoadState;

struct StandUnits {
  double slave, master;
  std::string slave_unit, master_unit;
};

StandUnits units_of_stand(const sim::cam::Cam& cam) {
  const bool turn = cam.slave == sim::cam::Coordinate::rotary, angle = cam.master == sim::cam::Coordinate::rotary;
  const double degrees = 180.0 / std::numbers::pi;
  return {turn ? degrees : 1e3, angle ? degrees : 1e3, turn ? "°" : "mm", angle ? "°" : "mm"};
}

template <class Value>
const LoadState& largest(const std::vector<LoadState>& states, const Value& value) {
  return *std::max_element(states.begin(), states.end(),
                           [&](const LoadState& a, const LoadState& b) { return value(a) < value(b); });
}

void add_stand_case(const StandCase& c, const sim::cam::Motion& motion, const StandUnits& units,
                    sim::ExperimentResult& result) {
  std::string key = c.model;
  std::replace(key.begin(), key.end(), '-', '_');
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& text, double value) {
    result.figures.push_back(
        {.name = name + "_" + key, .unit = unit, .text = text + ", " + c.label, .value = value, .expected = {}});
  };
  if (const auto dwell = longest_dwell(motion)) {
    const auto figures = dwell_figures(c.states, motion, *dwell);
    add("peak_to_peak", units.slave_unit, "load in the dwell, peak to peak", figures.peak_to_peak * units.slave);
    add("quality", units.slave_unit + " " + units.master_unit, "area of its deviation in the dwell",
        figures.quality * units.slave * units.master);
  }
  const auto& top = largest(c.states, [](const LoadState& s) { return s.position; });
  add("highest", units.slave_unit, "highest position of the load", top.position * units.slave);
  add("highest_at", units.master_unit, "where, of the master", top.master * units.master);
  const auto speeds = [&](const std::string& name, double sign, const std::string& text) {
    const auto& state = largest(c.states, [&](const LoadState& s) { return sign * s.speed; });
    add(name, units.slave_unit + "/s", text, state.speed * units.slave);
  };
  speeds("highest_speed", 1.0, "highest speed of the load");
  speeds("lowest_speed", -1.0, "lowest speed of the load");
  const auto accelerations = [&](const std::string& name, double sign, const std::string& text) {
    const auto& state = largest(c.states, [&](const LoadState& s) { return sign * s.acceleration; });
    add(name, units.slave_unit + "/s²", text, state.acceleration * units.slave);
  };
  accelerations("highest_acceleration", 1.0, "highest acceleration of the load");
  accelerations("lowest_acceleration", -1.0, "lowest acceleration of the load");
}

sim::Chart stand_chart(const std::vector<StandCase>& cases, const StandUnits& units, const std::string& title,
                       const std::string& unit, double (*value)(const LoadState&)) {
  sim::Chart chart;
  chart.title = title;
  chart.x_label = "master, " + units.master_unit;
  chart.y_label = unit;
  chart.shape.wide = true;
  for (const auto& c : cases) {
    sim::Series series{.name = c.label, .x = {}, .y = {}};
    for (const auto& state : c.states) {
      series.x.push_back(state.master * units.master);
      series.y.push_back(value(state) * units.slave);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

std::vector<std::string> stand_models() { return {"cascade", "transfer-function", "lagrange"}; }

sim::ExperimentResult stand_result(const sim::cam::Motion& motion, double master_speed,
                                   const std::vector<StandCase>& cases, const std::string& signals) {
  const auto units = units_of_stand(motion.cam);
  sim::ExperimentResult result;
  result.experiment = "cam-load";
  result.title = fmt::format("Cam {} on an elastic axis", motion.cam.name);
  result.signals = signals;
  result.question = "How does the load follow the cam, and how much does it oscillate in the dwell?";
  result.figures.push_back({.name = "theoretical_acceleration",
                            .unit = units.slave_unit + "/s²",
                            .text = "peak acceleration of the set-point",
                            .value = extremes(motion.curve, 2).magnitude() * master_speed * master_speed * units.slave,
                            .expected = {}});
  for (const auto& c : cases) add_stand_case(c, motion, units, result);
  const auto dwell = longest_dwell(motion);
  for (const auto& c : cases)
    result.findings.push_back(
        dwell
            ? fmt::format("The load oscillates by {:.4g} {} from peak to peak in the dwell, {}.",
                          dwell_figures(c.states, motion, *dwell).peak_to_peak * units.slave, units.slave_unit, c.label)
            : fmt::format("The motion has no dwell; nothing is said of residual vibration, {}.", c.label));
  result.charts = {stand_chart(cases, units, "Lift of the load", "position, " + units.slave_unit,
                               [](const LoadState& s) { return s.position; }),
                   stand_chart(cases, units, "Speed of the load", "speed, " + units.slave_unit + "/s",
                               [](const LoadState& s) { return s.speed; }),
                   stand_chart(cases, units, "Acceleration of the load", "acceleration, " + units.slave_unit + "/s²",
                               [](const LoadState& s) { return s.acceleration; })};
  return result;
}

sim::cam::Cam verification_cam() {
  constexpr double degree = std::numbers::pi / 180.0;
  sim::cam::Cam cam{.name = "verification"};
  cam.modulo = 68.18 * degree;
  cam.segments = {{.length = 90.0 * degree, .stroke = 68.18 * degree, .law = "parabola"}, {.length = 270.0 * degree}};
  return cam;
}

}  // namespace stiction::host
