// Apart from the figures: the page compiles the library of JSON without exceptions.
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/cam/step/result.hpp"

namespace stiction::host::step {
namespace {

using nlohmann::ordered_json;

constexpr double revolutions = turn / 60.0;

// Infinite and undefined numbers have no JSON.
ordered_json finite(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr); }

ordered_json profile_json(const StepResult& result, const StepProfile& profile) {
  const auto& made = result.made;
  ordered_json vertices = ordered_json::array();
  for (const auto& vertex : profile.vertices)
    vertices.push_back(
        {{"angle_deg", vertex.angle / degree}, {"radius_mm", 1e3 * vertex.radius}, {"peak", vertex.peak}});
  ordered_json arcs = ordered_json::array();
  for (const auto& arc : made.arcs)
    if (arc.cam == profile.row)
      arcs.push_back({{"begin_deg", wrapped(arc.arc.begin) / degree},
                      {"end_deg", wrapped(arc.arc.end) / degree},
                      {"kind", arc.valley ? "valley" : "peak"},
                      {"depth_mm", 1e3 * arc.shape.depth},
                      {"blend_deg", arc.shape.blend / degree}});
  return {{"least_radius_mm", 1e3 * profile.least_radius},
          {"largest_radius_mm", 1e3 * profile.largest_radius},
          {"vertices", vertices},
          {"arcs", arcs}};
}

// Each axis of symmetry with the two points of the first profile that it goes through.
ordered_json axes_json(const StepSynthesis& made) {
  ordered_json axes = ordered_json::array();
  const auto radius = [&](double angle) { return 1e3 * made.cut[0].radius_at(angle); };
  for (const double axis : made.symmetry.axes)
    axes.push_back({{"axis_deg", axis / degree}, {"radii_mm", {radius(axis), radius(axis + 0.5 * turn)}}});
  return axes;
}

ordered_json shares_json(const ContactShares& shares) {
  return {{"two_percent", 100.0 * shares.two},
          {"three_percent", 100.0 * shares.three},
          {"other_percent", 100.0 * shares.other}};
}

ordered_json tolerance_json(const ToleranceResult& t) {
  ordered_json shares = ordered_json::array();
  for (std::size_t k = 0; k < tolerance_names.size(); ++k)
    shares.push_back(
        {{"of", tolerance_names[k]}, {"play_um", 1e6 * t.play_share[k]}, {"pressure_MPa", 1e-6 * t.pressure_share[k]}});
  return {{"play_um", {1e6 * t.play.low, 1e6 * t.play.high}},
          {"pressure_MPa", {1e-6 * t.pressure.low, 1e-6 * t.pressure.high}},
          {"widest_at_deg", t.widest_psi / degree},
          {"shares", shares}};
}

}  // namespace

std::string step_json_text(const StepResult& result) {
  const auto& [project, made] = std::pair<const StepProject&, const StepSynthesis&>(result.project, result.made);
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
  const ordered_json document{
      {"schema", "stiction.cam-step/1"},
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
        {"speed_for_pressure_rpm", finite(result.speed_for_pressure / revolutions)},
        {"speed_before_lift_off_rpm", finite(result.speed_before_lift_off / revolutions)}}},
      {"tolerance", tolerance_json(result.tolerance)},
      {"comparison",
       {{"output_torque_N_m", c.output_torque},
        {"classic_torque_N_m", c.cam_torque},
        {"classic_power_W", c.cam_power},
        {"classic_speed_rpm", finite(c.step_cam_speed / revolutions)},
        {"electronic_torque_N_m", c.motor_torque},
        {"electronic_power_W", c.motor_power},
        {"electronic_inertia_kg_m2", c.motor_inertia},
        {"electronic_speed_rpm", finite(c.electronic_speed / revolutions)}}},
      {"stress_cycles_per_turn", made.count.paths},
      {"notes", made.notes},
      {"files", files}};
  return document.dump(2) + "\n";
}

}  // namespace stiction::host::step
