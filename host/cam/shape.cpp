#include "host/cam/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/cam/duty.hpp"

namespace stiction::host {
namespace {

// Of what the result shows: ° or mm of the slave, ° or mm of the master.
struct ShapingUnits {
  double slave, master;
  std::string slave_unit, master_unit, effort_unit;
};

ShapingUnits units_of_shaping(const sim::cam::Cam& cam) {
  const bool turn = cam.slave == sim::cam::Coordinate::rotary, angle = cam.master == sim::cam::Coordinate::rotary;
  const double degrees = 180.0 / std::numbers::pi;
  return {turn ? degrees : 1e3, angle ? degrees : 1e3, turn ? "°" : "mm", angle ? "°" : "mm", turn ? "N m" : "N"};
}

std::string key_of(std::string_view name) {
  std::string key(name);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

std::string verdict_of(const ShapingResult& result) {
  const auto units = units_of_shaping(result.task.motion.cam);
  const auto length = [&](double periods) {
    return fmt::format("{:.3g} periods, {:.4g} {}", periods, periods * result.task.period_length() * units.master,
                       units.master_unit);
  };
  const double band = 100.0 * result.task.band, wanted = result.wanted * units.slave;
  if (!result.least)
    return fmt::format("No lift of {} keeps the limits of the axis at this speed.", length(result.task.periods()));
  const double least = *result.least * units.slave;
  if (*result.least <= result.wanted)
    return fmt::format("A rise of {} can leave as little as {:.2g} {} over ±{:.3g} %: {:.2g} {} is possible.",
                       length(result.task.periods()), least, units.slave_unit, band, wanted, units.slave_unit);
  return fmt::format("No rise of {} leaves less than {:.2g} {} over ±{:.3g} %: {:.2g} {} is impossible; {}",
                     length(result.task.periods()), least, units.slave_unit, band, wanted, units.slave_unit,
                     result.shortest_periods ? fmt::format("the shortest rise that makes it possible takes {}.",
                                                           length(*result.shortest_periods))
                                             : "no rise of up to 8 periods makes it possible.");
}

void add_row(const ShapedRow& row, const ShapingUnits& units, sim::ExperimentResult& result) {
  const auto key = key_of(row.method->name);
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& text, double value) {
    result.figures.push_back({.name = name + "_" + key,
                              .unit = unit,
                              .text = fmt::format("{}: {}", row.method->label, text),
                              .value = value,
                              .expected = {}});
  };
  const auto& made = *row.made;
  for (std::size_t k = 0; k < made.from_rest.factors.size(); ++k) {
    const double percent = 100.0 * made.from_rest.factors[k];
    add(fmt::format("residual_at_{:.0f}_percent", percent), units.slave_unit,
        fmt::format("residual from peak to peak at {:.0f} % of the frequency", percent),
        made.from_rest.figures[k].peak_to_peak * units.slave);
  }
  add("residual_worst", units.slave_unit, "largest residual over the band", made.from_rest.worst * units.slave);
  add("residual_running", units.slave_unit, "the same in continuous running", made.running.worst * units.slave);
  add("quality_nominal", units.slave_unit + " " + units.master_unit, "area of the deviation in the dwell",
      made.from_rest.figures[made.from_rest.figures.size() / 2].quality * units.slave * units.master);
  add("acceleration_ratio", "", "peak acceleration over the parabola's", made.acceleration_ratio);
  const std::string unit = units.slave_unit == "°" ? "rad" : "m";
  add("peak_acceleration", unit + "/s²", "peak acceleration", made.acceleration);
  add("peak_jerk", unit + "/s^3", "peak jerk, its finite part", made.jerk);
  add(units.effort_unit == "N" ? "peak_force" : "peak_torque", units.effort_unit,
      "peak effort of the motor at the axis", row.torque);
  add("rise", units.master_unit, "until the set-point rests", made.rise * units.master);
}

// The rows that a chart has room for in colours that can be told apart: the first, and the five that leave least.
std::vector<const ShapedRow*> shown_rows(const ShapingResult& result) {
  constexpr std::size_t most = 6;
  std::vector<const ShapedRow*> rows;
  for (const auto& row : result.rows)
    if (row.made) rows.push_back(&row);
  if (rows.size() <= most) return rows;
  std::stable_sort(rows.begin() + 1, rows.end(), [](const ShapedRow* a, const ShapedRow* b) {
    return a->made->from_rest.worst < b->made->from_rest.worst;
  });
  rows.resize(most);
  return rows;
}

sim::Chart residual_chart(const ShapingResult& result, const ShapingUnits& units) {
  sim::Chart chart;
  chart.title = "Residual at the true frequency";
  chart.x_label = "frequency of the load, % of the nominal one";
  chart.y_label = "peak to peak, " + units.slave_unit;
  chart.shape.wide = true;
  chart.caption =
      "Each method is made for 100 %; the machine may be at any place of the band. Shown are "
      "the motion as it is and the five methods with the least residual.";
  constexpr int points = 33;
  for (const auto* row : shown_rows(result)) {
    const auto figures = band_figures(result.task, row->made->motion, points);
    sim::Series series{.name = std::string(row->method->label), .x = {}, .y = {}};
    for (std::size_t k = 0; k < figures.factors.size(); ++k) {
      series.x.push_back(100.0 * figures.factors[k]);
      series.y.push_back(figures.figures[k].peak_to_peak * units.slave);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

sim::Chart frontier_chart(const ShapingResult& result, const ShapingUnits& units) {
  sim::Chart chart;
  chart.title = "What no lift betters";
  chart.x_label = "rise, periods of the load";
  chart.y_label = "peak to peak over the band, " + units.slave_unit;
  sim::Series bound{.name = "least of all lifts within the limits", .x = {}, .y = {}};
  for (const auto& point : result.frontier) {
    bound.x.push_back(point.periods);
    bound.y.push_back(point.residual * std::fabs(result.task.stroke) * units.slave);
  }
  chart.series.push_back(std::move(bound));
  for (const auto* row : shown_rows(result))
    chart.series.push_back({.name = std::string(row->method->label),
                            .x = {row->made->rise / result.task.period_length()},
                            .y = {row->made->from_rest.worst * units.slave},
                            .points = true});
  return chart;
}

sim::Chart dwell_chart(const ShapingResult& result, const ShapingUnits& units) {
  sim::Chart chart;
  chart.title = "The load in the dwell, at the nominal frequency";
  chart.x_label = "master, " + units.master_unit;
  chart.y_label = "deviation, " + units.slave_unit;
  const auto& task = result.task;
  const double wanted = task.start + task.stroke;
  for (const auto* row : shown_rows(result)) {
    sim::Series series{.name = std::string(row->method->label), .x = {}, .y = {}};
    for (const auto& state : transfer_response(task.drive, row->made->motion, {.master_speed = task.master_speed})) {
      if (state.master < task.end() - 1e-9 || state.master > task.dwell.end()) continue;
      series.x.push_back(state.master * units.master);
      series.y.push_back((state.position - wanted) * units.slave);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

sim::cam::LiftLimits limits_of(const AxisLoad& load, double stroke, double rise_time) {
  sim::cam::LiftLimits limits;
  const double z = std::fabs(stroke), t = rise_time;
  limits.speed = std::min(limits.speed, load.max_speed * t / z);
  // Friction and weight are small beside what accelerates such a load; the check of the motion has them.
  const double acceleration = std::min(load.max_acceleration, load.largest_effort / load.inertia());
  limits.acceleration = std::min(limits.acceleration, acceleration * t * t / z);
  return limits;
}

ShapingResult shape(const sim::cam::ShapingTask& task, const AxisLoad& load,
                    const std::vector<const sim::cam::ShapingMethod*>& methods, double wanted) {
  ShapingResult result;
  result.task = task;
  result.wanted = wanted;
  for (const auto* method : methods) {
    ShapedRow row{method, shaped(task, *method)};
    if (row.made) {
      const Duty duty = duty_of(row.made->motion, load, task.master_speed);
      row.torque = std::fabs(duty.effort.motor.value);
      for (const Limit& limit : duty.limits)
        if (limit.broken() && row.broken.empty())
          row.broken = fmt::format("a {} of {:.4g} {} where the axis has {:.4g} {}", limit.name, limit.found,
                                   limit.unit, limit.allowed, limit.unit);
    }
    result.rows.push_back(std::move(row));
  }
  const double damping = task.mode().damping_ratio(), z = std::fabs(task.stroke);
  if (const auto least = least_residual(task.periods(), damping, task.band, task.limits)) result.least = *least * z;
  // The limits of the unit law grow with the square of the rise; for other lengths those of LiftLimits are taken.
  result.frontier = sim::cam::frontier(1.5, 4.0, 11, damping, task.band, {});
  if (!result.least || *result.least > wanted)
    result.shortest_periods = sim::cam::shortest_rise(wanted / z, damping, task.band, {});
  result.verdict = verdict_of(result);
  return result;
}

sim::ExperimentResult shaping_report(const ShapingResult& shaping) {
  const auto units = units_of_shaping(shaping.task.motion.cam);
  sim::ExperimentResult result;
  result.experiment = "cam-shape";
  result.title = fmt::format("Residual vibration of cam {}", shaping.task.motion.cam.name);
  result.question = "What does each method leave in the dwell, over the band of frequencies, and what does it ask for?";
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& text, double value) {
    result.figures.push_back({.name = name, .unit = unit, .text = text, .value = value, .expected = {}});
  };
  add("frequency", "Hz", "frequency of the load", shaping.task.mode().frequency() / (2.0 * std::numbers::pi));
  add("damping_ratio", "", "its damping ratio", shaping.task.mode().damping_ratio());
  add("periods", "", "its periods in the rise", shaping.task.periods());
  add("wanted", units.slave_unit, "wanted from peak to peak", shaping.wanted * units.slave);
  if (shaping.least)
    add("least", units.slave_unit, "what no lift within the limits betters", *shaping.least * units.slave);
  if (shaping.shortest_periods)
    add("shortest_rise", "", "periods of the shortest rise that leaves what is wanted", *shaping.shortest_periods);
  for (const auto& row : shaping.rows)
    if (row.made) add_row(row, units, result);
  result.findings.push_back(shaping.verdict);
  for (const auto& row : shaping.rows) {
    if (!row.made)
      result.findings.push_back(fmt::format("{}: the rise or the dwell is too short for it.", row.method->label));
    else if (!row.broken.empty())
      result.findings.push_back(
          fmt::format("{}: it asks for {}; no motion file is written.", row.method->label, row.broken));
  }
  result.charts = {residual_chart(shaping, units), frontier_chart(shaping, units), dwell_chart(shaping, units)};
  return result;
}

}  // namespace stiction::host
