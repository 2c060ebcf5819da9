#include "host/cli/diagnose_output.hpp"

#include <fmt/format.h>

#include "host/cli/output.hpp"
#include "host/diagnose/verdict_json.hpp"
#include "host/log/csv_log.hpp"
#include "host/report/diagnosis_report.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {

void put_out(const Verdict& verdict, const machine::Machine& machine, const MachineOptions& options,
             const std::string& out, bool json, const Invocation& invocation, const Origin& origin) {
  const auto document = verdict_json(verdict);
  if (!out.empty()) {
    PendingFolder folder(out, invocation.command);
    std::vector<machine::AxisEffects> additions;
    for (const auto& axis : machine.axes) {
      machine::AxisEffects effects{axis.name, {}};
      for (const auto& finding : verdict.findings)
        if (finding.axis == axis.name) effects.effects.push_back(finding.row());
      if (!effects.effects.empty()) additions.push_back(std::move(effects));
    }
    const std::vector<std::string> comment{"made by: " + invocation.command_line};
    folder.write("extended.toml",
                 sim::extended_machine(machine::find_machine(options.machine), options.set, additions, comment));
    sim::read_machine(folder.path() / "extended.toml");  // what was written must be a machine
    folder.write("verdict.json", document.dump(2) + "\n");
    if (verdict.next && verdict.next->log) {
      auto log = *verdict.next->log;
      log.comments = {{"made by", invocation.command_line},
                      {"proposed", fmt::format("{}: {}", verdict.next->trajectories.front().name,
                                               verdict.next->trajectories.front().words)},
                      {"set-points", "x_set, v_set, a_set; " + verdict.next->note},
                      {"not measured", "x and current come from the simulation of the machine file"}};
      folder.write(next_measurement_file, csv_log_text(log));
    }
    folder.write("report.html",
                 diagnosis_report_html({invocation.command_line, invocation.version, machine, verdict, origin}));
    folder.commit();
  }
  if (json) {
    fmt::print("{}\n", document.dump(2));
    return;
  }
  fmt::print("{}", verdict_text(verdict));
  if (!out.empty() && verdict.next && verdict.next->log)
    fmt::print("\nset-points to record: {}/{}", out, next_measurement_file);
  if (!out.empty())
    fmt::print("\nverdict: {0}/verdict.json\nmachine file: {0}/extended.toml\nreport: {0}/report.html\n", out);
}

}  // namespace stiction::host
