#include "host/cli/cam_spring_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stiction::host {
namespace {

// What a turn has at its extremes.
struct SpringPeaks {
  double steepest = 0.0, least_force = step::infinity, force = 0.0, pressure = 0.0, torque = 0.0;
  double least_psi = 0.0, pressure_psi = 0.0;
};

SpringPeaks peaks_of(const step::SpringCam& made) {
  SpringPeaks peaks;
  for (const auto& contact : made.contacts) {
    peaks.steepest = std::max(peaks.steepest, contact.pressure_angle);
    peaks.force = std::max(peaks.force, contact.force);
    peaks.torque = std::max(peaks.torque, std::fabs(contact.input_torque));
    if (contact.force < peaks.least_force) peaks.least_force = contact.force, peaks.least_psi = contact.psi;
    if (contact.pressure > peaks.pressure) peaks.pressure = contact.pressure, peaks.pressure_psi = contact.psi;
  }
  return peaks;
}

nlohmann::ordered_json speed_json(double speed) {
  return std::isfinite(speed) ? nlohmann::ordered_json(speed * 60.0 / step::turn) : nlohmann::ordered_json(nullptr);
}
std::string spring_speed(double speed) {
  return std::isfinite(speed) ? fmt::format("{:.5g} rpm", speed * 60.0 / step::turn) : std::string("any speed");
}

}  // namespace

nlohmann::ordered_json spring_json(const step::StepProject& project, const step::SpringCam& made,
                                   const std::vector<std::pair<std::string, std::string>>& files) {
  const SpringPeaks peaks = peaks_of(made);
  const auto radii = step::least_radii(std::span(&made.profile, 1));
  const auto radius = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(1e3 * value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  for (const auto& [name, checksum] : files) written.push_back({{"name", name}, {"crc32", checksum}});
  return {{"schema", "stiction.cam-spring/1"},
          {"project", project.name},
          {"least_radius_mm", 1e3 * made.profile.least_radius},
          {"largest_radius_mm", 1e3 * made.profile.largest_radius},
          {"least_convex_mm", radius(radii.convex)},
          {"least_concave_mm", radius(radii.concave)},
          {"worst_pressure_angle_deg", peaks.steepest / step::degree},
          {"largest_contact_N", peaks.force},
          {"least_contact_N", peaks.least_force},
          {"least_contact_at_deg", peaks.least_psi / step::degree},
          {"pressure_MPa", 1e-6 * peaks.pressure},
          {"pressure_at_deg", peaks.pressure_psi / step::degree},
          {"input_torque_N_m", peaks.torque},
          {"lift_off_speed_rpm", speed_json(made.lift_off_speed)},
          {"lift_off_at_deg", made.lift_off_psi / step::degree},
          {"speed_for_pressure_rpm", speed_json(made.speed_for_pressure)},
          {"notes", made.notes},
          {"files", written}};
}

std::string spring_text(const step::StepProject& project, const step::SpringCam& made) {
  const SpringPeaks peaks = peaks_of(made);
  std::string text = fmt::format(
      "{}: a cam with one roller on a spring\n"
      "Radius {:.4f} to {:.4f} mm, worst pressure angle {:.2f}°\n"
      "At {:.5g} rpm: contact force {:.4g} N (at {:.2f}°) to {:.4g} N, Hertz pressure {:.4g} MPa at {:.2f}°, input "
      "{:.4g} N m\n"
      "The roller stays on the cam up to {}",
      project.name, 1e3 * made.profile.least_radius, 1e3 * made.profile.largest_radius, peaks.steepest / step::degree,
      project.load.speed * 60.0 / step::turn, peaks.least_force, peaks.least_psi / step::degree, peaks.force,
      1e-6 * peaks.pressure, peaks.pressure_psi / step::degree, peaks.torque, spring_speed(made.lift_off_speed));
  if (std::isfinite(made.lift_off_speed))
    text += fmt::format(" and lifts off first at {:.2f}°", made.lift_off_psi / step::degree);
  text += "\n";
  if (project.load.largest_pressure)
    text += fmt::format("{:.4g} MPa are kept up to {}\n", 1e-6 * *project.load.largest_pressure,
                        spring_speed(made.speed_for_pressure));
  for (const auto& note : made.notes) text += note + "\n";
  return text;
}

}  // namespace stiction::host
