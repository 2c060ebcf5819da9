#include "host/cli/circle_command.hpp"

#include <fmt/format.h>

#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/report/circle_report.hpp"
#include "host/simulate/friction_choice.hpp"

namespace stiction::host {
namespace {

// Runs the failed case again, which repeats it to the bit, and keeps its trace.
[[noreturn]] void keep_trace_and_fail(const CaseFailed& failure, const CirclePlaces& places) {
  const auto& c = failure.circle_case;
  const std::string which = fmt::format("{} at {:g} m/min: ", friction_in_use(c.machine), c.settings.feed * 60.0);
  const auto record = [&](const std::filesystem::path& file) {
    try {
      run_traced(c, file);
    } catch (const FaultTripped&) {  // the one that is being reported
    }
  };
  std::filesystem::path kept;
  if (places.log.empty() && !places.out.empty()) {
    PendingFolder folder(places.out, places.command);
    record(folder.path() / "trace.csv");
    folder.write("result.json", nlohmann::ordered_json{{"schema", "stiction.fault/1"},
                                                       {"machine", c.machine.id},
                                                       {"axis", failure.axis},
                                                       {"fault", static_cast<int>(failure.fault)},
                                                       {"name", name_of(failure.fault)},
                                                       {"time_s", failure.time},
                                                       {"trace", "trace.csv"}}
                                        .dump(2) +
                                    "\n");
    folder.commit();
    kept = std::filesystem::path(places.out) / "trace.csv";
  } else {
    kept = places.log.empty() ? "stiction-fault.csv" : places.log;
    PendingFile file(kept);
    file.fill(record);
    file.commit();
  }
  throw std::runtime_error(
      fmt::format("{}{}; the run was stopped, and its trace is in {}", which, failure.what(), kept.string()));
}

}  // namespace

sim::CircleResult run_plan(const CirclePlan& plan, const CirclePlaces& places) {
  if (!places.log.empty()) {
    const auto cases = cases_of(plan);
    if (cases.size() != 1)
      throw UsageError(fmt::format(
          "--log: found {} runs; expected one run: one friction model, one feed and one direction", cases.size()));
  }
  try {
    Progress progress("circles", plan.friction.size() * plan.feeds.size() * plan.directions.size());
    auto result = run_circles(plan, [&] { progress.add(); });
    if (!places.log.empty()) {
      PendingFile file(places.log);
      file.fill([&](const auto& path) { run_traced(cases_of(plan).front(), path); });
      file.commit();
    }
    return result;
  } catch (const CaseFailed& failure) {
    keep_trace_and_fail(failure, places);
  }
}

void write_circle_folder(const std::filesystem::path& folder, const CirclePlan& plan, const sim::CircleResult& result,
                         const nlohmann::ordered_json& json, const Invocation& invocation, const std::string& machine) {
  PendingFolder pending(folder, invocation.command);
  const std::string title = plan.machine.axes.size() == 1 ? "Sine: " : "Circle: ";
  pending.write("report.html", circle_report_html({title + plan.machine.name, invocation.command_line,
                                                   invocation.version, plan.machine, result, report_origin(machine)}));
  pending.write("result.json", json.dump(2) + "\n");
  pending.commit();
}

}  // namespace stiction::host
