#include "host/cli/experiment_result_output.hpp"

#include <fmt/format.h>

#include "host/cli/output.hpp"
#include "host/output/experiment_output.hpp"
#include "host/report/experiment_report.hpp"

namespace stiction::host {

void write_experiment_folder(const std::string& out, const Invocation& invocation, const machine::Machine& machine,
                             const sim::ExperimentResult& result, const Origin& origin,
                             const nlohmann::ordered_json& json) {
  if (out.empty()) return;
  PendingFolder folder(out, invocation.command);
  folder.write("report.html",
               experiment_report_html({invocation.command_line, invocation.version, machine, result, origin}));
  folder.write("result.json", json.dump(2) + "\n");
  folder.commit();
}

void print_experiment(const sim::ExperimentResult& result, const machine::Machine& machine,
                      const std::vector<std::string>& logs, const std::string& out) {
  fmt::print("{}", experiment_text(result, machine));
  for (const auto& log : logs) fmt::print("{}log: {}\n", &log == &logs.front() ? "\n" : "", log);
  if (!out.empty()) fmt::print("\nreport: {}/report.html\n", out);
}

}  // namespace stiction::host
