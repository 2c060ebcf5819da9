#include "host/cli/cam_options.hpp"

#include <algorithm>

#include "sim/cam/laws.hpp"

namespace stiction::host {
void MotionOptions::add_to(CLI::App& command, bool several) {
  command.add_option("MOTION", motion, "motion file (stiction.cam/1)")->required()->type_name("MOTION");
  command.add_option("--cam", cam, several ? "name of one cam of the file [all]" : "name of the cam [the only one]")
      ->type_name("NAME");
}

std::vector<sim::cam::Cam> MotionOptions::cams() const { return cams_of(motion, cam, "--cam"); }

sim::cam::Cam MotionOptions::one() const { return one_cam(motion, cam, "--cam"); }

machine::Machine machine_of_cam(const MachineOptions& options) {
  return options.load(options.machine, "", cam_needs());
}

AxisLoad load_of_axis(const MachineOptions& options, const sim::cam::Cam* cam) {
  return axis_of_cam(machine_of_cam(options), options.axis, cam);
}

std::vector<std::string> cam_tasks() {
  std::vector<std::string> tasks;
  for (const auto& law : sim::cam::laws())
    if (std::find(tasks.begin(), tasks.end(), task_of(law)) == tasks.end()) tasks.push_back(task_of(law));
  std::sort(tasks.begin(), tasks.end());
  return tasks;
}

}  // namespace stiction::host
