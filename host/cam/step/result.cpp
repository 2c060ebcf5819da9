#include "host/cam/step/result.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/cam/duty.hpp"

namespace stiction::host::step {
namespace {

constexpr double per_minute = turn / 60.0;
// How late a roller is that is driven over the corners, m: what wear and clearance make of it.
constexpr double late_roller = 2e-5;

StepComparison compare(const StepProject& project, const StepSynthesis& made, double step_cam_speed) {
  AxisLoad load;
  load.load = project.load.inertia;
  if (project.electronic) {
    load.rotor = project.electronic->rotor;
    if (project.electronic->largest_torque > 0.0) load.largest_effort = project.electronic->largest_torque;
  }
  sim::cam::Cam cam{.name = project.name, .modulo = made.lift.stroke()};
  cam.segments = {{.length = turn, .stroke = made.lift.stroke()}};
  const sim::cam::Motion motion{cam, made.lift.curve(), {{0, made.lift.curve().pieces().size()}}};
  const Duty duty = duty_of(motion, load, project.load.speed);
  return {std::fabs(duty.effort.load.value),
          std::fabs(duty.effort.cam.value),
          duty.effort.cam_power,
          std::fabs(duty.effort.motor.value),
          duty.effort.peak_power,
          load.inertia(),
          step_cam_speed,
          duty.highest_speed()};
}

}  // namespace

StepResult step_result(const StepProject& project, const StepSynthesis& made) {
  const auto& m = project.mechanism;
  StepResult result{project,
                    made,
                    peaks_of(made.forces, project.load.speed),
                    tolerance_of(m, made.lift, project.load, made.contacts, project.tolerances),
                    lead_ins(m, made.lift, made.cut, made.profiles, late_roller),
                    {},
                    speed_for_pressure(m, made.lift, project.load, made.contacts),
                    speed_before_lift_off(m, made.lift, project.load, made.contacts)};
  result.comparison = compare(project, made, result.speed_for_pressure);
  return result;
}

double worst_pressure_angle(const StepSynthesis& made) {
  double worst = 0.0;
  for (const auto& set : made.contacts)
    for (const auto& contact : set.contacts)
      if (contact.needed) worst = std::max(worst, contact.pressure_angle());
  return worst;
}

std::vector<StepFigure> step_figures(const StepResult& result) {
  const auto& made = result.made;
  const auto& peaks = result.peaks;
  const auto& t = result.tolerance;
  const auto& c = result.comparison;
  const auto cut = made.shares(made.unrelieved), relieved = made.shares(made.contacts);
  const auto number = [](double value, int digits) { return fmt::format("{:.{}f}", value, digits); };
  const auto speed = [&](double value) {
    return std::isfinite(value) ? number(value / per_minute, 1) : std::string("any");
  };
  std::vector<StepFigure> figures;
  for (const auto& profile : made.profiles)
    figures.push_back({fmt::format("radius of cam {}", profile.row + 1),
                       fmt::format("{:.4f} to {:.4f}", 1e3 * profile.least_radius, 1e3 * profile.largest_radius),
                       "mm"});
  figures.push_back(
      {"two, three contacts before relief", fmt::format("{:.2f}, {:.2f}", 100.0 * cut.two, 100.0 * cut.three), "%"});
  figures.push_back({"exactly two contacts after relief", number(100.0 * relieved.two, 2), "%"});
  figures.push_back({"worst pressure angle of needed contacts", number(worst_pressure_angle(made) / degree, 2), "°"});
  figures.push_back({"largest contact force", number(peaks.force, 1), "N"});
  figures.push_back({fmt::format("largest Hertz pressure, at {:.2f}°", peaks.pressure_psi / degree),
                     number(1e-6 * peaks.pressure, 1), "MPa"});
  figures.push_back({"largest torque of the carousel, of the cam shaft",
                     fmt::format("{:.4g}, {:.4g}", peaks.output_torque, peaks.input_torque), "N m"});
  figures.push_back({"largest load of the bearings", number(peaks.bearing, 1), "N"});
  if (result.project.load.largest_pressure)
    figures.push_back({"highest speed for the stated pressure", speed(result.speed_for_pressure), "r/min"});
  if (result.project.load.preload > 0.0)
    figures.push_back(
        {"highest speed before a needed contact lifts off", speed(result.speed_before_lift_off), "r/min"});
  figures.push_back({"play of the carousel within the tolerances, below 0: pressed",
                     fmt::format("{:.1f} to {:.1f}", 1e6 * t.play.low, 1e6 * t.play.high), "µm"});
  figures.push_back({"peak of the Hertz pressure within them",
                     fmt::format("{:.1f} to {:.1f}", 1e-6 * t.pressure.low, 1e-6 * t.pressure.high), "MPa"});
  figures.push_back({"torque of an electronic cam with the same motion", number(c.motor_torque, 2), "N m"});
  return figures;
}

}  // namespace stiction::host::step
