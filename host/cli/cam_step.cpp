// `stiction cam step`: two cam profiles from a project, relieved by rule, as files that a shop loads.
#include <fmt/format.h>

#include <memory>

#include "host/cam/step/shop_folder.hpp"
#include "host/cli/cam_spring_output.hpp"
#include "host/cli/cam_step_output.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/csv_marks.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"

namespace stiction::host {
namespace {

struct StepOptions {
  std::string project, out, columns, separator = ",", decimal = ".";
  bool json = false;
};

step::TableLayout layout_of(const StepOptions& o) {
  step::TableLayout layout;
  if (!o.columns.empty()) layout.columns = split_list(o.columns);
  for (const auto& column : layout.columns) {
    std::vector<std::string> known;
    for (const auto& each : step::table_columns()) known.emplace_back(each.name);
    require_known("--columns", column, "a column", known);
  }
  const auto [separator, decimal] = csv_marks(o.separator, o.decimal);
  layout.separator = separator;
  layout.decimal = decimal;
  return layout;
}

step::FileOrigin origin_of(const Invocation& invocation, const step::StepProject& project) {
  return {"stiction " + invocation.version, project.name};
}

void write_files(step::StepResult& result, const StepOptions& options, const Invocation& invocation) {
  PendingFolder folder(options.out, invocation.command);
  for (const auto& [name, text] : shop_folder(result, layout_of(options), origin_of(invocation, result.project)))
    folder.write(name, text);
  Origin sources;
  sources.sources.push_back(options.project);
  folder.write("report.html", step_page(result, invocation.command_line, invocation.version, sources));
  folder.commit();
}

void run_spring(const step::StepProject& project, const StepOptions& options, const Invocation& invocation) {
  const auto made = synthesize_spring_cam(project);
  std::vector<std::pair<std::string, std::string>> files;
  if (!options.out.empty()) {
    PendingFolder folder(options.out, invocation.command);
    for (const auto& [name, text] :
         shop_tables(project, made.profile, layout_of(options), origin_of(invocation, project))) {
      folder.write(name, text);
      files.emplace_back(name, fmt::format("{:08x}", step::checksum_of(text)));
    }
    for (const auto& [name, text] : source_files(project)) folder.write(name, text);
    folder.write("result.json", spring_json(project, made, files).dump(2) + "\n");
    folder.commit();
  }
  if (options.json)
    fmt::print("{}\n", spring_json(project, made, files).dump(2));
  else
    fmt::print("{}{}", spring_text(project, made), options.out.empty() ? "" : fmt::format("Files: {}\n", options.out));
}

std::string files_text(const std::string& out) {
  return fmt::format(
      "Files: {0}, page: {0}/report.html\nSTEP solids of both cams: `toolchain/step {0}` of the source tree installs "
      "OpenCASCADE (190 MB) and "
      "writes them there\n",
      out);
}

void run_step(const StepOptions& options, const Invocation& invocation) {
  const auto project = step::read_step_project(options.project);
  try {
    if (project.spring) return run_spring(project, options, invocation);
    const auto made = synthesize(project);
    step::StepResult result = step_result(project, made);
    if (!options.out.empty()) write_files(result, options, invocation);
    if (options.json)
      fmt::print("{}", step_json_text(result));
    else
      fmt::print("{}{}", step_text(result), options.out.empty() ? "" : files_text(options.out));
  } catch (const sim::cam::CamError& error) {
    throw UsageError(fmt::format("{}: {}", options.project, error.what()));
  }
}

}  // namespace

void add_cam_step(CLI::App& cam, const Invocation& invocation) {
  auto* command = cam.add_subcommand(
      "step", "make both profiles of a step cam from a project, relieved, for a shop, or a single cam with a spring");
  auto o = std::make_shared<StepOptions>();
  command->add_option("PROJECT", o->project, "project of a step cam (TOML)")->required()->type_name("PROJECT");
  add_out(
      *command, o->out,
      "write drawings (DXF), manufacturing coordinates and inspection tables (CSV) and report.html, which shows the "
      "mechanism at any angle, into this folder");
  std::string help = "columns of the coordinates, in their order [angle, radius, wheel_angle, wheel_radius, normal]:";
  for (const auto& column : step::table_columns())
    help += fmt::format("{} {}: {}", &column == &step::table_columns().front() ? "" : ";", column.name, column.text);
  command->add_option("--columns", o->columns, help)->type_name("COLUMNS");
  command->add_option("--separator", o->separator, "of the tables: one character, or tab [,]")->type_name("CHARACTER");
  command->add_option("--decimal", o->decimal, "of the tables: decimal mark, a point or a comma [.]")
      ->type_name("MARK");
  command->add_flag("--json", o->json, "print the figures as JSON on standard output");
  command->callback([o, &invocation] { run_step(*o, invocation); });
}

}  // namespace stiction::host
