// `stiction cam studio`: a motion and a machine as one page in which the motion is edited.
#include "host/cli/cam_studio.hpp"

#include <fmt/format.h>

#include <memory>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "host/studio/page.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host {
namespace {

struct StudioOptions {
  std::string motion, machine, speed = "60 rpm", out;
};

StudioFile file_of(const std::filesystem::path& path) { return {path.filename().string(), machine::content_of(path)}; }

void run_studio(const StudioOptions& options, const Invocation& invocation) {
  StudioPageContent content;
  content.command = invocation.command_line;
  content.version = invocation.version;
  auto master = sim::cam::Coordinate::rotary;
  if (!options.motion.empty()) {
    master = sim::cam::read_motion_file(options.motion).front().master;
    content.motion = file_of(options.motion);
  }
  if (!options.machine.empty()) content.machine = file_of(machine::find_machine(options.machine));
  content.speed_text = options.speed;
  content.master_speed = master_speed("--speed", options.speed, master);
  std::string page;
  try {
    page = studio_page(content);
  } catch (const sim::cam::CamError& error) {
    throw UsageError(fmt::format("--machine: {}", error.what()));
  }
  PendingFile file(options.out);
  file.write(page);
  file.commit();
  fmt::print("Studio: {} ({:.1f} MB), a page that opens offline\n", options.out,
             1e-6 * static_cast<double>(page.size()));
}

}  // namespace

void add_cam_studio(CLI::App& cam, const Invocation& invocation) {
  auto* command = cam.add_subcommand(
      "studio", "write a page in which a motion is edited by dragging, next to the simulated machine that follows it");
  auto o = std::make_shared<StudioOptions>();
  command->add_option("MOTION", o->motion, "motion file (stiction.cam/1) to begin with [an empty motion]")
      ->type_name("MOTION");
  command
      ->add_option("--machine", o->machine,
                   "shipped machine by name, or a machine file, whose axis follows the motion [none: curves alone]")
      ->type_name("MACHINE");
  command
      ->add_option("--speed", o->speed,
                   "speed of the master to begin with, such as \"130 rpm\" or \"0.5 m/s\" [60 rpm]")
      ->type_name("SPEED");
  add_output_file(*command, "--out", o->out, "write the page into this file (HTML)")->required();
  command->callback([o, &invocation] { run_studio(*o, invocation); });
}

}  // namespace stiction::host
