#include "host/simulate/cam_run_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/cam/laws.hpp"

namespace stiction::host {
namespace {

struct CamUnits {
  double error;  // of the slave's unit
  std::string error_unit;
  double master;
  std::string master_label;
  std::string effort_unit;
};

CamUnits units_of(const sim::cam::Cam& cam) {
  const bool turn = cam.slave == sim::cam::Coordinate::rotary, angle = cam.master == sim::cam::Coordinate::rotary;
  return {turn ? 180.0 / std::numbers::pi * 1e3 : 1e6, turn ? "mdeg" : "um", angle ? 180.0 / std::numbers::pi : 1e3,
          angle ? "master, °" : "master, mm", turn ? "N m" : "N"};
}

void add_case(const CamRunCase& c, const CamUnits& units, sim::ExperimentResult& result) {
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& text, double value) {
    result.figures.push_back(
        {.name = name + "_" + c.name, .unit = unit, .text = text + ", " + c.label, .value = value, .expected = {}});
  };
  add("mean_error", units.error_unit, "mean following error", c.run.error.mean * units.error);
  add("peak_error", units.error_unit, "peak following error", c.run.error.peak * units.error);
  for (std::size_t k = 0; k < c.run.segments.size(); ++k) {
    const auto segment = fmt::format("segment_{}", k + 1), text = fmt::format("segment {}", k + 1);
    add(segment + "_mean", units.error_unit, text + ": mean following error", c.run.segments[k].mean * units.error);
    add(segment + "_peak", units.error_unit, text + ": peak following error", c.run.segments[k].peak * units.error);
  }
  const std::string effort = units.effort_unit == "N" ? "force" : "torque";
  add("peak_" + effort, units.effort_unit, "peak " + effort + " of the motor", c.run.peak_effort);
  add("rms_" + effort, units.effort_unit, "rms " + effort + " of the motor", c.run.rms_effort);
  add("peak_power", "W", "peak power", c.run.peak_power);
  add("energy", "J", "energy of a cycle", c.run.energy);
}

// "2.85 °", where "2850 m°" is hard to read.
std::string length_of(double error, const CamUnits& units) {
  const bool way = units.error_unit == "um", large = std::abs(error) >= 1000.0;
  return large ? fmt::format("{:.3g} {}", error / 1000.0, way ? "mm" : "°")
               : fmt::format("{:.3g} {}", error, way ? "µm" : "m°");
}

sim::Series series_of(const CamRunCase& c, const std::vector<double>& values, double x, double y) {
  sim::Series series{.name = c.label, .x = {}, .y = {}};
  for (std::size_t k = 0; k < values.size(); ++k) {
    series.x.push_back(c.run.master[k] * x);
    series.y.push_back(values[k] * y);
  }
  return series;
}

}  // namespace

sim::ExperimentResult cam_run_result(const sim::cam::Motion& motion, const machine::AxisModel& axis,
                                     const std::string& signals, const std::vector<CamRunCase>& cases) {
  const auto units = units_of(motion.cam);
  sim::ExperimentResult result;
  result.experiment = "cam-run";
  result.title = fmt::format("Cam {} on axis {}", motion.cam.name, axis.name);
  result.signals = signals;
  result.question = "How closely does the axis follow the cam, and what does it take?";
  sim::Chart errors, efforts;
  errors.title = "Following error";
  errors.y_label = units.error_unit == "um" ? "error, µm" : "error, m°";
  efforts.title = units.effort_unit == "N" ? "Motor force" : "Motor torque";
  efforts.y_label = (units.effort_unit == "N" ? "force, " : "torque, ") + units.effort_unit;
  errors.x_label = efforts.x_label = units.master_label;
  errors.shape.wide = efforts.shape.wide = true;
  for (const auto& c : cases) {
    if (!c.stopped.empty()) continue;
    add_case(c, units, result);
    errors.series.push_back(series_of(c, c.run.following, units.master, units.error));
    efforts.series.push_back(series_of(c, c.run.effort, units.master, 1.0));
  }
  result.charts = {errors, efforts};
  for (const auto& c : cases)
    if (!c.stopped.empty())
      result.findings.push_back(fmt::format("A fault stops the axis {}: {}.", c.label, c.stopped));
  for (const auto& c : cases)
    if (c.stopped.empty())
      result.findings.push_back(fmt::format("The following error is {} at most, at {:.4g} {} of the master, {}.",
                                            length_of(c.run.error.peak * units.error, units),
                                            c.run.error.place * units.master,
                                            motion.cam.master == sim::cam::Coordinate::rotary ? "°" : "mm", c.label));
  return result;
}

}  // namespace stiction::host
