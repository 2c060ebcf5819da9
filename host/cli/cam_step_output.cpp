#include "host/cli/cam_step_output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/report/step_cam_report.hpp"

namespace stiction::host {
namespace {

using step::degree;

constexpr double rpm = step::turn / 60.0;
std::string speed_text(double speed) {
  return std::isfinite(speed) ? fmt::format("{:.5g} rpm", speed / rpm) : std::string("any speed");
}

}  // namespace

std::string step_text(const step::StepResult& result) {
  const auto& project = result.project;
  const auto& made = result.made;
  const auto& peaks = result.peaks;
  const auto& c = result.comparison;
  const auto cut = made.shares(made.unrelieved), relieved = made.shares(made.contacts);
  std::string text = fmt::format(
      "{}: {:.6g}° in a turn, {} rollers a row; the carousel is back after {} turns, each row leaves {} path{}\n",
      project.name, made.lift.stroke() / degree, project.mechanism.rollers, made.count.turns, made.count.paths,
      made.count.paths == 1 ? "" : "s");
  for (const auto& profile : made.profiles) {
    text += fmt::format("Cam {}: radius {:.4f} to {:.4f} mm\n", profile.row + 1, 1e3 * profile.least_radius,
                        1e3 * profile.largest_radius);
    for (const auto& arc : made.arcs)
      if (arc.cam == profile.row)
        text += fmt::format("  {} from {:.1f}° to {:.1f}° is not needed: relief {:.4g} mm, blends {:.4g}°\n",
                            arc.valley ? "valley" : "peak", step::wrapped(arc.arc.begin) / degree,
                            step::wrapped(arc.arc.end) / degree, 1e3 * arc.shape.depth, arc.shape.blend / degree);
  }
  text +=
      made.symmetry.holds()
          ? fmt::format("Cam 2 is cam 1 mirrored about {:.4f}°, the zero pin's line{}\n", made.symmetry.axis / degree,
                        made.symmetry.axes.size() > 1
                            ? fmt::format("; {} more axes would do", made.symmetry.axes.size() - 1)
                            : "")
          : fmt::format("Cam 2 has a profile of its own: mirrored, cam 1 differs from it by {:.4g} mm at best\n",
                        1e3 * made.symmetry.distance);
  text += fmt::format("Contacts: two in {:.2f} %, three in {:.2f} % of the turn; after relief two in {:.2f} %\n",
                      100.0 * cut.two, 100.0 * cut.three, 100.0 * relieved.two);
  text += fmt::format("Worst pressure angle of the needed contacts: {:.2f}°\n", worst_pressure_angle(made) / degree);
  for (const auto& each : result.lead_ins)
    text += fmt::format(
        "A roller 20 µm late at {:.2f}° of cam {}, {}: pressed by {:.1f} µm before relief, {:.1f} µm after\n",
        each.angle / degree, each.cam + 1, each.forwards ? "forwards" : "backwards", 1e6 * each.cut,
        1e6 * each.relieved);
  text += fmt::format(
      "At {:.5g} rpm: output {:.4g} N m, input {:.4g} N m and {:.4g} W, largest contact force {:.4g} N, Hertz pressure "
      "{:.4g} MPa at {:.2f}° (pressure angle {:.1f}°), bearings {:.4g} N\n",
      project.load.speed / rpm, peaks.output_torque, peaks.input_torque, peaks.input_power, peaks.force,
      1e-6 * peaks.pressure, peaks.pressure_psi / degree, peaks.pressure_angle / degree, peaks.bearing);
  if (project.load.largest_pressure)
    text += fmt::format("{:.4g} MPa are kept up to {}\n", 1e-6 * *project.load.largest_pressure,
                        speed_text(result.speed_for_pressure));
  if (project.load.preload > 0.0)
    text += fmt::format("No needed contact lifts off up to {}\n", speed_text(result.speed_before_lift_off));
  const auto& t = result.tolerance;
  text += fmt::format(
      "Tolerances: play {:.1f} to {:.1f} µm at the rollers, pressure {:.4g} to {:.4g} MPa. Half widths of "
      "the play at {:.1f}°:",
      1e6 * t.play.low, 1e6 * t.play.high, 1e-6 * t.pressure.low, 1e-6 * t.pressure.high, t.widest_psi / degree);
  for (std::size_t k = 0; k < step::tolerance_names.size(); ++k)
    text += fmt::format("{} {} {:.1f} µm", k == 0 ? "" : ",", step::tolerance_names[k], 1e6 * t.play_share[k]);
  text += fmt::format(
      "\nClassic cam: {:.4g} N m, {:.4g} W, {}. Electronic cam: {:.4g} N m, {:.4g} W for {:.4g} kg m², {}\n",
      c.cam_torque, c.cam_power, speed_text(c.step_cam_speed), c.motor_torque, c.motor_power, c.motor_inertia,
      speed_text(c.electronic_speed));
  for (const auto& note : made.notes) text += note + "\n";
  return text;
}

std::string step_page(const step::StepResult& result, const std::string& command, const std::string& version,
                      const Origin& origin) {
  const StepCamReport report{command, version, result.project, result.made, step_figures(result), origin};
  return step_cam_report_html(report);
}

}  // namespace stiction::host
