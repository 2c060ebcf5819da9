#include "host/cli/diagnose_output.hpp"

#include <fmt/format.h>

#include "host/cli/output.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/log/csv_log.hpp"
#include "host/report/diagnosis_report.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

std::vector<machine::AxisEffects> additions_of(const std::vector<Verdict>& verdicts, const machine::Machine& machine) {
  std::vector<machine::AxisEffects> additions;
  for (const auto& axis : machine.axes) {
    machine::AxisEffects effects{axis.name, {}};
    for (const auto& verdict : verdicts)
      for (const auto& finding : verdict.findings)
        if (finding.axis == axis.name && finding.withheld.empty()) effects.effects.push_back(finding.row());
    if (!effects.effects.empty()) additions.push_back(std::move(effects));
  }
  return additions;
}

// Of the logs' axes that of this page alone.
Origin origin_of_axis(Origin origin, const std::string& axis) {
  std::erase_if(origin.abilities,
                [&](const AxisAbility& each) { return !axis.empty() && !each.axis.empty() && each.axis != axis; });
  return origin;
}

// Of the only axis without its name.
std::string suffix_of(const Verdict& verdict, std::size_t axes) { return axes > 1 ? verdict.axis : ""; }

std::string next_measurement_csv(const NextMeasurement& next, const Invocation& invocation) {
  auto log = *next.log;
  log.comments = {{"made by", invocation.command_line},
                  {"proposed", fmt::format("{}: {}", next.trajectories.front().name, next.trajectories.front().words)},
                  {"set-points", "x_set, v_set, a_set; " + next.note},
                  {"not measured", "x and current come from the simulation of the machine file"}};
  return csv_log_text(log);
}

std::string next_measurement_cam(const NextMeasurement& next, const std::string& axis, const Invocation& invocation) {
  return fmt::format(
      "# The cam to record next: {} cycles with the master at {}, once it turns steadily.\n# {}\n# made by: {}\n# In "
      "the simulation, from this folder: {}\n\n{}",
      next.cam->cycles, next.cam->speed, next.note, invocation.command_line, next_measurement_command(next, axis),
      sim::cam::motion_text({next.cam->cam}));
}

void write_folder(const std::vector<Verdict>& verdicts, const machine::Machine& machine, const DiagnosedFile& file,
                  const std::string& out, const Invocation& invocation, const Origin& origin) {
  PendingFolder folder(out, invocation.command);
  const std::vector<std::string> comment{"made by: " + invocation.command_line};
  folder.write("extended.toml", sim::extended_machine(file.file, file.set, additions_of(verdicts, machine), comment));
  sim::read_machine(folder.path() / "extended.toml");  // what was written must be a machine
  folder.write("verdict.json", verdict_json(verdicts).dump(2) + "\n");
  for (const auto& verdict : verdicts) {
    const auto axis = suffix_of(verdict, verdicts.size());
    if (verdict.next && verdict.next->log)
      folder.write(next_measurement_file_of(axis), next_measurement_csv(*verdict.next, invocation));
    if (verdict.next && verdict.next->cam)
      folder.write(next_measurement_cam_of(axis), next_measurement_cam(*verdict.next, axis, invocation));
    folder.write(diagnosis_page_of(axis), diagnosis_report_html({invocation.command_line, invocation.version, machine,
                                                                 verdict, origin_of_axis(origin, verdict.axis), axis}));
  }
  if (verdicts.size() > 1)
    folder.write("report.html",
                 diagnosed_axes_html(verdicts, {invocation.command_line, invocation.version, machine, {}, origin}));
  folder.commit();
}

}  // namespace

void put_out(const std::vector<Verdict>& verdicts, const machine::Machine& machine, const DiagnosedFile& file,
             const std::string& out, bool json, const Invocation& invocation, const Origin& origin) {
  if (!out.empty()) write_folder(verdicts, machine, file, out, invocation, origin);
  if (json) {
    fmt::print("{}\n", verdict_json(verdicts).dump(2));
    return;
  }
  for (const auto& verdict : verdicts) {
    if (verdicts.size() > 1) fmt::print("{}axis {}\n", &verdict == &verdicts.front() ? "" : "\n", verdict.axis);
    fmt::print("{}", verdict_text(verdict));
    const auto axis = suffix_of(verdict, verdicts.size());
    if (!out.empty() && verdict.next && verdict.next->cam)
      fmt::print("\ncam to record: {}/{}\nin simulation, from that folder: {}", out, next_measurement_cam_of(axis),
                 next_measurement_command(*verdict.next, axis));
    else if (!out.empty() && verdict.next && verdict.next->log)
      fmt::print("\nset-points to record: {}/{}", out, next_measurement_file_of(axis));
  }
  if (!out.empty())
    fmt::print("\nverdict: {0}/verdict.json\nmachine file: {0}/extended.toml\nreport: {0}/report.html\n", out);
}

}  // namespace stiction::host
