// Every figure of a step cam: what the command prints, and what its pages and files have.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/cam/step/lead_in.hpp"
#include "host/cam/step/synthesis.hpp"
#include "host/cam/step/tolerance.hpp"

namespace stiction::host::step {

// A classic step cam and an electronic cam that make the same motion.
struct StepComparison {
  double output_torque = 0.0, cam_torque = 0.0, cam_power = 0.0;  // N m, N m, W: M_D, M_H
  double motor_torque = 0.0, motor_power = 0.0;                   // N m, W, with the rotor
  double motor_inertia = 0.0;                                     // kg m^2, that the motor turns
  double step_cam_speed = 0.0, electronic_speed = 0.0;            // rad/s, the highest; infinite: no limit is stated
};

struct StepResult {
  const StepProject& project;
  const StepSynthesis& made;
  ForcePeaks peaks;
  ToleranceResult tolerance;
  std::vector<LeadIn> lead_ins;
  StepComparison comparison;
  double speed_for_pressure = 0.0, speed_before_lift_off = 0.0;  // rad/s
  std::vector<std::pair<std::string, std::string>> files{};      // name, CRC-32
};

// All figures of `made`, a synthesis of `project`; both must stay as long as the result does.
StepResult step_result(const StepProject& project, const StepSynthesis& made);

// The largest pressure angle of the contacts that the carousel needs, rad.
double worst_pressure_angle(const StepSynthesis& made);

// A line of the table of figures; `unit` may be empty.
struct StepFigure {
  std::string text, value, unit;
};
// The figures of `result` as pages show them.
std::vector<StepFigure> step_figures(const StepResult& result);

// "stiction.cam-step/1", as the file result.json has it.
std::string step_json_text(const StepResult& result);

}  // namespace stiction::host::step
