// The result of `stiction cam step` as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/cam/step/lead_in.hpp"
#include "host/cam/step/synthesis.hpp"
#include "host/cam/step/tolerance.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

// A classic step cam and an electronic cam that make the same motion.
struct StepComparison {
  double output_torque = 0.0, cam_torque = 0.0, cam_power = 0.0;  // N m, N m, W: M_D, M_H
  double motor_torque = 0.0, motor_power = 0.0;                   // N m, W, with the rotor
  double motor_inertia = 0.0;                                     // kg m^2, that the motor turns
  double step_cam_speed = 0.0, electronic_speed = 0.0;            // rad/s, the highest; infinite: no limit is stated
};

struct StepResult {
  const step::StepProject& project;
  const step::StepSynthesis& made;
  step::ForcePeaks peaks;
  step::ToleranceResult tolerance;
  std::vector<step::LeadIn> lead_ins;
  StepComparison comparison;
  double speed_for_pressure = 0.0, speed_before_lift_off = 0.0;  // rad/s
  std::vector<std::pair<std::string, std::string>> files{};      // name, CRC-32
};

// All figures of `made`, a synthesis of `project`; both must stay as long as the result does.
StepResult step_result(const step::StepProject& project, const step::StepSynthesis& made);

// The page of `result`. `command`: the command line, `version` of stiction, `origin`: the source files.
std::string step_page(const StepResult& result, const std::string& command, const std::string& version,
                      const Origin& origin);

// "stiction.cam-step/1", and as text.
nlohmann::ordered_json step_json(const StepResult& result);
std::string step_text(const StepResult& result);

}  // namespace stiction::host
