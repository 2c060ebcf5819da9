#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/cli/cam_output.hpp"
#include "sim/cam/motion_keys.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json peak_json(const sim::cam::Peak& peak) { return {{"value", peak.value}, {"master", peak.place}}; }

json effort_json(const Duty& duty) {
  const auto& e = duty.effort;
  return {{"output_M_D", peak_json(e.load)}, {"classic_cam_M_H", peak_json(e.cam)},
          {"motor", peak_json(e.motor)},     {"motor_rms", e.motor_rms},
          {"motor_power_W", e.peak_power},   {"classic_cam_power_W", e.cam_power},
          {"energy_J_per_cycle", e.energy}};
}

json duty_json(const CamCheck& check) {
  const Duty& duty = *check.duty;
  json extremes = json::object();
  for (int order = 0; order < 4; ++order) {
    const auto& found = duty.extremes[static_cast<std::size_t>(order)];
    extremes[std::string(sim::cam::derivative_name(order))] = {{"lowest", peak_json(found.lowest)},
                                                               {"highest", peak_json(found.highest)}};
  }
  json limits = json::array();
  for (const Limit& limit : duty.limits)
    limits.push_back({{"limit", limit.name},
                      {"unit", limit.unit},
                      {"found", limit.found},
                      {"allowed", limit.allowed},
                      {"master", limit.place},
                      {"broken", limit.broken()},
                      {"highest_speed", number(limit.highest_speed)}});
  json result{{"master_speed", duty.master_speed},
              {"extremes", extremes},
              {"limits", limits},
              {"effort", check.load ? effort_json(duty) : json(nullptr)}};
  if (check.load) result["axis"] = check.load->axis;
  return result;
}

// A place of the master as engineers read it.
std::string place_text(sim::cam::Coordinate master, double place) {
  return master == sim::cam::Coordinate::rotary ? fmt::format("{:.6g}°", place * 180.0 / 3.14159265358979323846)
                                                : fmt::format("{:.6g} mm", place * 1e3);
}
std::string speed_text(sim::cam::Coordinate master, double speed) {
  if (!std::isfinite(speed)) return "any speed";
  return master == sim::cam::Coordinate::rotary ? fmt::format("{:.5g} rpm", speed * 30.0 / 3.14159265358979323846)
                                                : fmt::format("{:.5g} m/s", speed);
}

std::string jumps_text(const CamCheck& check) {
  const sim::cam::Coordinate master = check.motion.cam.master;
  std::string text;
  std::size_t jerk_steps = 0;
  for (const auto& found : check.jumps) {
    if (found.jump.order == 3) {
      ++jerk_steps;
      continue;
    }
    text += fmt::format("  The {} jumps by {:.4g} at {}, {}, segment {} ({:.3g} of its peak).\n",
                        sim::cam::derivative_name(found.jump.order), found.jump.height,
                        place_text(master, found.jump.place), name_of(found.where), found.segment + 1, found.share);
  }
  if (text.empty()) text = "  Position, speed and acceleration are continuous, over the seam too.\n";
  if (jerk_steps > 0) text += fmt::format("  The jerk steps at {} places; no acceleration does there.\n", jerk_steps);
  return text;
}

std::string extremes_text(const CamCheck& check) {
  const sim::cam::Coordinate master = check.motion.cam.master;
  const std::string unit(unit_of(check.motion.cam.slave));
  const char* const rates[] = {"", "/s", "/s²", "/s³"};
  std::string text = fmt::format("\n  at {}\n", speed_text(master, check.duty->master_speed));
  for (int order = 0; order < 4; ++order) {
    const auto& found = check.duty->extremes[static_cast<std::size_t>(order)];
    text += fmt::format("  {:<14} {:>12.5g} at {:<12} {:>12.5g} at {:<12} {}{}\n", sim::cam::derivative_name(order),
                        found.lowest.value, place_text(master, found.lowest.place), found.highest.value,
                        place_text(master, found.highest.place), unit, rates[order]);
  }
  return text;
}

std::string effort_text(const CamCheck& check) {
  const auto& e = check.duty->effort;
  const AxisLoad& load = *check.load;
  const sim::cam::Coordinate master = check.motion.cam.master;
  const char* const shaft = master == sim::cam::Coordinate::rotary ? "N m" : "N";
  std::string text = fmt::format("\n  {:<44} {:>12} {:<4} {:>10}\n", "", "peak", "", "power");
  text += fmt::format("  {:<44} {:>12.5g} {:<4}\n", "load alone at the output, M_D", std::fabs(e.load.value),
                      load.effort_unit());
  text += fmt::format("  {:<44} {:>12.5g} {:<4} {:>10.4g} W\n", "classic cam at the master's shaft, M_H",
                      std::fabs(e.cam.value), shaft, e.cam_power);
  text += fmt::format("  {:<44} {:>12.5g} {:<4} {:>10.4g} W\n", "electronic cam: motor with rotor and friction",
                      std::fabs(e.motor.value), load.effort_unit(), e.peak_power);
  text += fmt::format("  {:<44} {:>12.5g} {:<4}\n", "the same, rms", e.motor_rms, load.effort_unit());
  if (std::isfinite(load.largest_effort))
    text += fmt::format("  {:<44} {:>12.1f} %\n", "the motor's reserve",
                        100.0 * (1.0 - std::fabs(e.motor.value) / load.largest_effort));
  text += fmt::format("  {:<44} {:>12.5g} J\n", "energy of a cycle", e.energy);
  return text;
}

std::string limits_text(const CamCheck& check) {
  const sim::cam::Coordinate master = check.motion.cam.master;
  std::string text = "\n";
  for (const Limit& limit : check.duty->limits) {
    if (limit.broken())
      text +=
          fmt::format("  LIMIT: the {} is {:.5g} {} at {}; the axis allows {:.5g} {}{}.\n", limit.name, limit.found,
                      limit.unit, place_text(master, limit.place), limit.allowed, limit.unit,
                      limit.highest_speed > 0.0 ? ", which it keeps up to " + speed_text(master, limit.highest_speed)
                                                : " at no speed");
    else
      text += fmt::format("  The {} keeps its limit: {:.5g} of {:.5g} {}, up to {}.\n", limit.name, limit.found,
                          limit.allowed, limit.unit, speed_text(master, limit.highest_speed));
  }
  return text;
}

}  // namespace

bool CamCheck::failed() const {
  return (duty && duty->broken()) ||
         std::any_of(jumps.begin(), jumps.end(), [](const auto& found) { return found.jump.order < 2; });
}

nlohmann::ordered_json check_json(const std::string& motion, const std::vector<CamCheck>& checks) {
  json cams = json::array();
  for (const CamCheck& check : checks) {
    json jumps = json::array();
    for (const auto& found : check.jumps)
      jumps.push_back({{"derivative", std::string(sim::cam::derivative_name(found.jump.order))},
                       {"master", found.jump.place},
                       {"height", found.jump.height},
                       {"share", found.share},
                       {"where", std::string(name_of(found.where))},
                       {"segment", found.segment + 1}});
    const auto& cam = check.motion.cam;
    cams.push_back({{"cam", cam.name},
                    {"master_unit", std::string(unit_of(cam.master))},
                    {"slave_unit", std::string(unit_of(cam.slave))},
                    {"cycle", cam.cycle()},
                    {"segments", cam.segments.size()},
                    {"jumps", jumps},
                    {"at_speed", check.duty ? duty_json(check) : json(nullptr)},
                    {"passed", !check.failed()}});
  }
  return {{"schema", "stiction.cam-check/1"}, {"motion", motion}, {"cams", cams}};
}

std::string check_text(const CamCheck& check) {
  const auto& cam = check.motion.cam;
  std::string text = fmt::format("{}: {} segments over {}{}\n", cam.name, cam.segments.size(),
                                 place_text(cam.master, cam.cycle()), cam.periodic ? "" : ", once");
  text += jumps_text(check);
  if (check.duty) text += extremes_text(check);
  if (check.load) text += effort_text(check) + limits_text(check);
  return text;
}

}  // namespace stiction::host
