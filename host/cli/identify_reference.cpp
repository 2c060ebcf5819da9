#include "host/cli/identify_reference.hpp"

#include <fmt/format.h>

#include "firmware/machine/file/machine_file.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/identify/measured_machine_result.hpp"
#include "host/output/experiment_output.hpp"
#include "host/report/experiment_report.hpp"
#include "host/simulate/expected_figures.hpp"

namespace stiction::host {

void identify_reference(const IdentifyReferenceOptions& options, const Invocation& invocation) try {
  require_known("--reference", options.reference, "rows of the machine file", {"circle"});
  const auto machine = options.machine.load(options.machine.machine, "circle", needs_of("identify --reference circle"));
  permitted_rows(machine);  // says what is missing before anything runs
  const auto l_shape = options.machine.load(options.machine.machine, "l-shape");
  const auto study = during("identifying", [&] { return study_measured_machine(machine, l_shape); });
  auto result = measured_machine_result(machine, study);
  add_expected_figures(result, machine);
  const auto json = experiment_json(result, machine);
  if (!options.out.empty()) {
    PendingFolder folder(options.out, invocation.command);
    folder.write("report.html",
                 experiment_report_html(
                     {invocation.command_line, invocation.version, with_friction(machine, study.identified), result,
                      report_origin(options.machine.machine, {"rows of the machine file, " + options.reference})}));
    folder.write("result.json", json.dump(2) + "\n");
    folder.write("identified.toml", friction_toml(study.identified));
    folder.commit();
  }
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n{}", experiment_text(result, machine), prediction_text(machine, study));
  if (!options.out.empty()) fmt::print("\nreport: {}/report.html\n", options.out);
} catch (const MissingRows& error) {
  throw UsageError(fmt::format("{}: {}", machine::find_machine(options.machine.machine).string(), error.what()));
}

}  // namespace stiction::host
