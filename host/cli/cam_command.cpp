// `stiction cam`: lift laws, checks of motion files, the drive's table; the other commands have sources of their own.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "host/cli/cam_options.hpp"
#include "host/cli/cam_output.hpp"
#include "host/cli/cam_studio.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "sim/cam/law.hpp"
#include "sim/cam/laws_page.hpp"
#include "sim/cam/segment_table.hpp"

namespace stiction::host {
namespace {

struct LawsOptions {
  std::string task, picture;
  bool json = false, markdown = false;
};

void run_laws(const LawsOptions& options) {
  if (!options.picture.empty()) {
    PendingFile file(options.picture);
    file.write(sim::cam::laws_svg());
    file.commit();
  }
  if (options.markdown) {
    fmt::print("{}", sim::cam::laws_markdown());
    return;
  }
  std::vector<const sim::cam::Law*> chosen;
  for (const auto& law : sim::cam::laws())
    if (options.task.empty() || task_of(law) == options.task) chosen.push_back(&law);
  if (options.json)
    fmt::print("{}\n", laws_json(chosen).dump(2));
  else
    fmt::print("{}", laws_text(chosen));
}

void add_laws(CLI::App& cam) {
  auto* command = cam.add_subcommand("laws", "list the lift laws with their characteristic values");
  auto o = std::make_shared<LawsOptions>();
  command
      ->add_option("--task", o->task,
                   "only those for a task of VDI 2143: R rest, G constant speed, U reversal, B motion")
      ->check(one_of(cam_tasks()))
      ->type_name("TASK");
  command->add_flag("--markdown", o->markdown, "print all of them as a table for a page (Markdown)");
  add_output_file(*command, "--picture", o->picture, "write a picture of all of them into this file (SVG)");
  command->add_flag("--json", o->json, "print names, parameters, formulas and figures as JSON on standard output");
  command->get_option("--markdown")->excludes("--json");
  command->callback([o] { run_laws(*o); });
}

struct CheckOptions {
  MotionOptions motion;
  MachineOptions machine;
  std::string speed;
  bool json = false;
};

CamCheck checked(const CheckOptions& options, const sim::cam::Cam& cam) {
  CamCheck check{sim::cam::compose(cam), {}};
  check.jumps = jumps_of(check.motion);
  if (options.speed.empty()) return check;
  const double speed = master_speed("--speed", options.speed, cam.master);
  if (!options.machine.machine.empty()) check.load = load_of_axis(options.machine, &cam);
  check.duty = check.load ? duty_of(check.motion, *check.load, speed) : duty_of(check.motion, speed);
  return check;
}

// Why the command fails: what is printed on standard error.
std::string failure_of(const CheckOptions& options, const CamCheck& check) {
  const auto place = fmt::format("{}: {}: ", options.motion.motion, check.motion.cam.name);
  if (!check.duty || !check.duty->broken()) return place + "the position or the speed jumps, which no axis can follow";
  const double highest = check.duty->highest_speed();
  const bool rotary = check.motion.cam.master == sim::cam::Coordinate::rotary;
  if (highest == 0.0) return place + "a limit of the axis is broken at any speed";
  return fmt::format("{}a limit of the axis is broken; the highest speed that keeps all is {:.5g} {}", place,
                     rotary ? highest * 30.0 / std::numbers::pi : highest, rotary ? "rpm" : "m/s");
}

void run_check(const CheckOptions& options) {
  if (!options.machine.machine.empty() && options.speed.empty())
    throw UsageError("--speed: found --machine without it; expected the master's speed, such as \"130 rpm\"");
  std::vector<CamCheck> checks;
  for (const sim::cam::Cam& cam : options.motion.cams()) checks.push_back(checked(options, cam));
  if (options.json)
    fmt::print("{}\n", check_json(options.motion.motion, checks).dump(2));
  else
    for (const auto& check : checks) fmt::print("{}{}", &check == &checks.front() ? "" : "\n", check_text(check));
  for (const auto& check : checks)
    if (check.failed()) throw std::runtime_error(failure_of(options, check));
}

void add_check(CLI::App& cam) {
  auto* command =
      cam.add_subcommand("check", "find jumps of a motion, and at a speed the limits of the axis that it breaks");
  auto o = std::make_shared<CheckOptions>();
  o->motion.add_to(*command, true);
  o->machine.add_to(*command, "shipped machine by name, or a machine file, that follows the cam");
  command->get_option("--machine")->required(false);
  o->machine.add_axis_to(*command);
  command->add_option("--speed", o->speed, "speed of the master, such as \"130 rpm\" or \"0.5 m/s\"")
      ->type_name("SPEED");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o] { run_check(*o); });
}

struct TableOptions {
  MotionOptions motion;
  std::string tolerance = "1e-9", out;
};

// A bare number is a share of the range of positions.
double tolerance_of(const TableOptions& options, const sim::cam::Motion& motion) {
  const bool rotary = motion.cam.slave == sim::cam::Coordinate::rotary;
  const auto& text = options.tolerance;
  char* end = nullptr;
  const double share = std::strtod(text.c_str(), &end);
  if (end != text.c_str() && *end == '\0') {
    if (share > 0.0) return table_tolerance(motion, share);
  }
  const double tolerance =
      cam_quantity("--tolerance", text, rotary ? "rad" : "m",
                   "a share of the range of positions such as 1e-9, or a quantity such as \"1 nm\"");
  if (!(tolerance > 0.0)) throw UsageError(fmt::format("--tolerance: found '{}'; expected more than 0", text));
  return tolerance;
}

void run_table(const TableOptions& options) {
  const sim::cam::Cam cam = options.motion.one();
  PendingFile file(options.out);
  const sim::cam::Motion motion = sim::cam::compose(cam);
  const auto table = table_within(motion, tolerance_of(options, motion));
  file.write(std::string_view(reinterpret_cast<const char*>(table.bytes.data()), table.bytes.size()));
  file.commit();
  const char* const unit = cam.slave == sim::cam::Coordinate::rotary ? "rad" : "m";
  const double cycle = cam.cycle();
  const char* const over = cam.master == sim::cam::Coordinate::rotary ? "rad" : "m";
  fmt::print(
      "{}: {} segments, {} bytes\nproven errors: position {:.3g} {}, speed {:.3g} {}/{}, acceleration {:.3g} {}/{}²\n",
      options.out, table.segments, table.bytes.size(), table.bound.position, unit, table.bound.speed / cycle, unit,
      over, table.bound.acceleration / (cycle * cycle), unit, over);
}

void add_table(CLI::App& cam) {
  auto* command = cam.add_subcommand("table", "write the drive's table of a motion, with a proven bound of its error");
  auto o = std::make_shared<TableOptions>();
  o->motion.add_to(*command);
  command
      ->add_option("--tolerance", o->tolerance,
                   "largest error of the position: a share of its range, or a quantity such as \"1 nm\" [1e-9]")
      ->type_name("TOLERANCE");
  add_output_file(*command, "--out,-o", o->out, "file to write")->required();
  command->callback([o] { run_table(*o); });
}

}  // namespace

void add_cam(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand("cam", "lift laws, motion files and tables of electronic cams");
  expect_subcommand(*command, "command");
  add_laws(*command);
  add_check(*command);
  add_cam_design(*command, invocation);
  add_cam_rank(*command);
  add_table(*command);
  add_cam_exchange(*command);
  add_cam_shape(*command, invocation);
  add_cam_step(*command, invocation);
  add_cam_studio(*command, invocation);
}

}  // namespace stiction::host
