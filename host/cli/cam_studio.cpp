// `stiction cam studio` and `stiction cam open`: a motion and a machine as one page in which the motion is edited, from
// a motion file or from whatever holds a motion.
#include "host/cli/cam_studio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "host/cam/exchange.hpp"
#include "host/cam/step/project.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "host/log/read_log.hpp"
#include "host/studio/page.hpp"
#include "host/studio/read_back.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host {
namespace {

struct StudioOptions {
  std::string motion, machine, step, speed = "60 rpm", out;
};

struct OpenOptions {
  StudioOptions page;
  std::string format, master = "rotary", slave = "rotary";
};

StudioFile file_of(const std::filesystem::path& path) { return {path.filename().string(), machine::content_of(path)}; }

// The page of `content` with the rest of `options`; `master`: kind of the motion's.
void write_studio(StudioPageContent content, sim::cam::Coordinate master, const StudioOptions& options,
                  const Invocation& invocation) {
  content.command = invocation.command_line;
  content.version = invocation.version;
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

// The motion file that a project is of, where it is of one.
std::string motion_of(const std::filesystem::path& file, const step::StepProject& project) {
  return project.measured ? std::string() : (file.parent_path() / project.motion_file).string();
}

void run_studio(const StudioOptions& options, const Invocation& invocation) {
  StudioPageContent content;
  auto master = sim::cam::Coordinate::rotary;
  std::string motion = options.motion;
  if (!options.step.empty()) {
    const auto project = step::read_step_project(options.step);
    if (project.spring)
      throw UsageError(fmt::format(
          "--step {}: found a single cam with a spring; expected a pair of cams: `stiction cam step` makes single ones",
          options.step));
    if (motion.empty()) motion = motion_of(options.step, project);
    content.step = file_of(options.step);
  }
  if (!motion.empty()) {
    master = sim::cam::read_motion_file(motion).front().master;
    content.motion = file_of(motion);
  }
  write_studio(std::move(content), master, options, invocation);
}

// The cam that `file` holds, whatever it is. Throws sim::cam::CamError.
sim::cam::Cam read_any(const std::string& file, const std::string& text, const OpenOptions& options) {
  constexpr const char* name = "opened";
  if (text.starts_with("SCAM"))
    return cam_of_table({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, name);
  const auto& formats = exchange_formats();
  std::string_view format = options.format.empty() ? looks_like(text) : std::string_view(options.format);
  if (std::any_of(formats.begin(), formats.end(), [&](const auto& each) { return each.name == format; })) {
    const auto kind = [](const std::string& given) {
      return given == "linear" ? sim::cam::Coordinate::linear : sim::cam::Coordinate::rotary;
    };
    const sim::cam::Cam like{.name = name, .master = kind(options.master), .slave = kind(options.slave)};
    return imported(text, exchange_format(format), {}, like);
  }
  return cam_of_log(read_log(file), name);
}

void run_open(const OpenOptions& options, const Invocation& invocation) {
  const auto& file = options.page.motion;
  const auto text = machine::read_whole_file(file, "a motion file, a table, a log of a cam or a step-cam project");
  if (looks_like(text) == "a motion file" && options.format.empty()) return run_studio(options.page, invocation);
  if (text.find(step::project_schema) != std::string::npos) {
    const auto project = step::read_step_project(file);
    auto of_project = options.page;
    of_project.motion = motion_of(file, project);
    if (!project.spring) of_project.step = file;
    return run_studio(of_project, invocation);
  }
  sim::cam::Cam cam;
  try {
    cam = read_any(file, text, options);
  } catch (const sim::cam::CamError& error) {
    throw UsageError(fmt::format("{}: {}", file, error.what()));
  }
  StudioPageContent content;
  content.motion = {std::filesystem::path(file).stem().string() + ".toml", sim::cam::motion_text({cam})};
  write_studio(std::move(content), cam.master, options.page, invocation);
}

void add_page_options(CLI::App& command, StudioOptions& o) {
  command
      .add_option("--machine", o.machine,
                  "shipped machine by name, or a machine file, whose axis follows the motion [none: curves alone]")
      ->type_name("MACHINE");
  command
      .add_option("--speed", o.speed, "speed of the master to begin with, such as \"130 rpm\" or \"0.5 m/s\" [60 rpm]")
      ->type_name("SPEED");
  add_output_file(command, "--out", o.out, "write the page into this file (HTML)")->required();
}

}  // namespace

void add_cam_studio(CLI::App& cam, const Invocation& invocation) {
  auto* command = cam.add_subcommand(
      "studio", "write a page in which a motion is edited by dragging, next to the simulated machine that follows it");
  auto o = std::make_shared<StudioOptions>();
  command->add_option("MOTION", o->motion, "motion file (stiction.cam/1) to begin with [an empty motion]")
      ->type_name("MOTION");
  command
      ->add_option("--step", o->step,
                   "project of a step cam, whose mechanism and relief the page has too; its motion, where no MOTION is "
                   "given [none]")
      ->type_name("PROJECT");
  add_page_options(*command, *o);
  command->callback([o, &invocation] { run_studio(*o, invocation); });

  auto* open = cam.add_subcommand(
      "open",
      "write the studio of any file that holds a motion: a motion file, a table of the drive or of a different "
      "maker, a log of a cam, a project of a step cam");
  auto p = std::make_shared<OpenOptions>();
  open->add_option("FILE", p->page.motion, "file to read; what it is, is told by its content")
      ->required()
      ->type_name("FILE");
  std::vector<std::string> names;
  for (const auto& format : exchange_formats()) names.emplace_back(format.name);
  open->add_option("--format", p->format, "format of a table, where its content does not say it [by its content]")
      ->check(one_of(names))
      ->type_name("FORMAT");
  open->add_option("--master", p->master, "kind of the master of a table [rotary]")
      ->check(one_of({"rotary", "linear"}))
      ->type_name("KIND");
  open->add_option("--slave", p->slave, "kind of the slave of a table [rotary]")
      ->check(one_of({"rotary", "linear"}))
      ->type_name("KIND");
  add_page_options(*open, p->page);
  open->callback([p, &invocation] { run_open(*p, invocation); });
}

}  // namespace stiction::host
