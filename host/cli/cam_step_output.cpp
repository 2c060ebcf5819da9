#include "host/cli/cam_step_output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/cam/duty.hpp"
#include "host/report/step_cam_report.hpp"

namespace stiction::host {
namespace {

using nlohmann::ordered_json;
using step::degree;

constexpr double rpm = step::turn / 60.0;
// How late a roller is that is driven over the corners, m: what wear and clearance make of it.
constexpr double late_roller = 2e-5;

// Infinite and undefined numbers have no JSON.
ordered_json finite(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr); }

StepComparison compare(const step::StepProject& project, const step::StepSynthesis& made, double step_cam_speed) {
  AxisLoad load;
  load.load = project.load.inertia;
  if (project.electronic) {
    load.rotor = project.electronic->rotor;
    if (project.electronic->largest_torque > 0.0) load.largest_effort = project.electronic->largest_torque;
  }
  sim::cam::Cam cam{.name = project.name, .modulo = made.lift.stroke()};
  cam.segments = {{.length = step::turn, .stroke = made.lift.stroke()}};
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

ordered_json profile_json(const StepResult& result, const step::StepProfile& profile) {
  const auto& made = result.made;
  ordered_json vertices = ordered_json::array();
  for (const auto& vertex : profile.vertices)
    vertices.push_back(
        {{"angle_deg", vertex.angle / degree}, {"radius_mm", 1e3 * vertex.radius}, {"peak", vertex.peak}});
  ordered_json arcs = ordered_json::array();
  for (const auto& arc : made.arcs)
    if (arc.cam == profile.row)
      arcs.push_back({{"begin_deg", step::wrapped(arc.arc.begin) / degree},
                      {"end_deg", step::wrapped(arc.arc.end) / degree},
                      {"kind", arc.valley ? "valley" : "peak"},
                      {"depth_mm", 1e3 * arc.shape.depth},
                      {"blend_deg", arc.shape.blend / degree}});
  return {{"least_radius_mm", 1e3 * profile.least_radius},
          {"largest_radius_mm", 1e3 * profile.largest_radius},
          {"vertices", vertices},
          {"arcs", arcs}};
}

// Each axis of symmetry with the two points of the first profile that it goes through.
ordered_json axes_json(const step::StepSynthesis& made) {
  ordered_json axes = ordered_json::array();
  const auto radius = [&](double angle) { return 1e3 * made.cut[0].radius_at(angle); };
  for (const double axis : made.symmetry.axes)
    axes.push_back({{"axis_deg", axis / degree}, {"radii_mm", {radius(axis), radius(axis + 0.5 * step::turn)}}});
  return axes;
}

ordered_json shares_json(const step::ContactShares& shares) {
  return {{"two_percent", 100.0 * shares.two},
          {"three_percent", 100.0 * shares.three},
          {"other_percent", 100.0 * shares.other}};
}

double worst_pressure_angle(const step::StepSynthesis& made) {
  double worst = 0.0;
  for (const auto& set : made.contacts)
    for (const auto& contact : set.contacts)
      if (contact.needed) worst = std::max(worst, contact.pressure_angle());
  return worst;
}

ordered_json tolerance_json(const step::ToleranceResult& t) {
  ordered_json shares = ordered_json::array();
  for (std::size_t k = 0; k < step::tolerance_names.size(); ++k)
    shares.push_back({{"of", step::tolerance_names[k]},
                      {"play_um", 1e6 * t.play_share[k]},
                      {"pressure_MPa", 1e-6 * t.pressure_share[k]}});
  return {{"play_um", {1e6 * t.play.low, 1e6 * t.play.high}},
          {"pressure_MPa", {1e-6 * t.pressure.low, 1e-6 * t.pressure.high}},
          {"widest_at_deg", t.widest_psi / degree},
          {"shares", shares}};
}

std::string speed_text(double speed) {
  return std::isfinite(speed) ? fmt::format("{:.5g} rpm", speed / rpm) : std::string("any speed");
}

}  // namespace

StepResult step_result(const step::StepProject& project, const step::StepSynthesis& made) {
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

ordered_json step_json(const StepResult& result) {
  const auto& [project, made] =
      std::pair<const step::StepProject&, const step::StepSynthesis&>(result.project, result.made);
  const auto needed = least_radii(made.unrelieved);
  ordered_json lead_ins = ordered_json::array();
  for (const auto& each : result.lead_ins)
    lead_ins.push_back({{"cam", each.cam + 1},
                        {"angle_deg", each.angle / degree},
                        {"direction", each.forwards ? "forwards" : "backwards"},
                        {"pressed_cut_um", 1e6 * each.cut},
                        {"pressed_relieved_um", 1e6 * each.relieved}});
  ordered_json files = ordered_json::array();
  for (const auto& [name, checksum] : result.files) files.push_back({{"name", name}, {"crc32", checksum}});
  const auto& peaks = result.peaks;
  const auto& c = result.comparison;
  return {{"schema", "stiction.cam-step/1"},
          {"project", project.name},
          {"stroke_deg", made.lift.stroke() / degree},
          {"turns", made.count.turns},
          {"paths", made.count.paths},
          {"cams", {profile_json(result, made.profiles[0]), profile_json(result, made.profiles[1])}},
          {"symmetry",
           {{"mirrored", made.symmetry.holds()},
            {"axis_deg", made.symmetry.axis / degree},
            {"distance_um", 1e6 * made.symmetry.distance},
            {"axes", axes_json(made)}}},
          {"contacts",
           {{"cut", shares_json(made.shares(made.unrelieved))}, {"relieved", shares_json(made.shares(made.contacts))}}},
          {"worst_pressure_angle_deg", worst_pressure_angle(made) / degree},
          {"needed_radii_mm", {{"convex", finite(1e3 * needed.convex)}, {"concave", finite(1e3 * needed.concave)}}},
          {"lead_ins", lead_ins},
          {"forces",
           {{"output_torque_N_m", peaks.output_torque},
            {"input_torque_N_m", peaks.input_torque},
            {"input_power_W", peaks.input_power},
            {"contact_N", peaks.force},
            {"pressure_MPa", 1e-6 * peaks.pressure},
            {"pressure_at_deg", peaks.pressure_psi / degree},
            {"pressure_angle_there_deg", peaks.pressure_angle / degree},
            {"bearing_N", peaks.bearing},
            {"least_needed_N", finite(peaks.least_force)},
            {"speed_for_pressure_rpm", finite(result.speed_for_pressure / rpm)},
            {"speed_before_lift_off_rpm", finite(result.speed_before_lift_off / rpm)}}},
          {"tolerance", tolerance_json(result.tolerance)},
          {"comparison",
           {{"output_torque_N_m", c.output_torque},
            {"classic_torque_N_m", c.cam_torque},
            {"classic_power_W", c.cam_power},
            {"classic_speed_rpm", finite(c.step_cam_speed / rpm)},
            {"electronic_torque_N_m", c.motor_torque},
            {"electronic_power_W", c.motor_power},
            {"electronic_inertia_kg_m2", c.motor_inertia},
            {"electronic_speed_rpm", finite(c.electronic_speed / rpm)}}},
          {"stress_cycles_per_turn", made.count.paths},
          {"notes", made.notes},
          {"files", files}};
}

std::string step_text(const StepResult& result) {
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

std::string step_page(const StepResult& result, const std::string& command, const std::string& version,
                      const Origin& origin) {
  const auto& made = result.made;
  const auto& peaks = result.peaks;
  const auto& t = result.tolerance;
  const auto& c = result.comparison;
  const auto cut = made.shares(made.unrelieved), relieved = made.shares(made.contacts);
  const auto number = [](double value, int digits) { return fmt::format("{:.{}f}", value, digits); };
  const auto speed = [&](double value) { return std::isfinite(value) ? number(value / rpm, 1) : std::string("any"); };
  StepCamReport report{command, version, result.project, made, {}, origin};
  auto& figures = report.figures;
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
  return step_cam_report_html(report);
}

}  // namespace stiction::host
