// The project of a step cam, "stiction.step-cam/1": its lift, mechanism, load, relief and what the shop has.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/cam/step/forces.hpp"
#include "host/cam/step/relief.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host::step {

inline constexpr std::string_view project_schema = "stiction.step-cam/1";

// Half widths of the tolerances, m: each dimension is its nominal value and up to so much more or less.
struct StepTolerances {
  double axis_distance = 1e-5, roller = 1e-5, arm = 1e-5, profile = 1e-5, preload = 1e-5;
};

// The electronic cam that the step cam is compared with.
struct ElectronicCam {
  double rotor = 0.0;           // kg m^2, of the motor at the axis
  double largest_torque = 0.0;  // N m, at the axis; 0: not stated
};

// A spring that holds the one roller of a single cam on it; no spring: a pair of cams holds the carousel.
struct ReturnSpring {
  double rate = 0.0;     // N m/rad, about the arm's axis
  double preload = 0.0;  // N m, where the lift is 0
};

struct StepProject {
  std::string name;
  std::string motion_file{}, cam_name{};   // as the file has them; the second is empty where it names none
  std::optional<sim::cam::Cam> cam{};      // of a motion file,
  std::optional<MeasuredLift> measured{};  // or a table
  StepMechanism mechanism;
  StepLoad load;
  ReliefSettings relief;
  double wheel_radius = 0.0;  // m, of the grinding wheel; 0: not stated
  StepTolerances tolerances;
  std::optional<ElectronicCam> electronic{};
  std::optional<ReturnSpring> spring{};
  int steps = 3600;     // of the manufacturing angle and of the cam's angle, in a turn
  double chord = 1e-6;  // m, of arcs and splines in files

  // The motion file without its folder.
  std::string motion_name() const;
};

// The project of `file`; the motion file or table that it names is sought beside it. Throws machine::MachineFileError
// "FILE:LINE: KEY: found ...; expected ...".
StepProject read_step_project(const std::filesystem::path& file);

namespace detail {
// The cams of the motion file of that name.
using MotionSource = std::function<std::vector<sim::cam::Cam>(const std::string&)>;
// The project of `text`, the content of `file`, with the cams that `motion` has. Throws machine::MachineFileError.
StepProject parsed(const std::string& file, const std::string& text, const MotionSource& motion);
}  // namespace detail

// The same of a text that names no other file but `motion`, which is its text; `file` is the name in messages. Knows no
// files, so that pages have it too.
StepProject parse_step_project(const std::string& file, const std::string& text, const std::string& motion);

}  // namespace stiction::host::step
