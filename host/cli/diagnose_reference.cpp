#include "host/cli/diagnose_reference.hpp"

#include <fmt/format.h>

#include "firmware/machine/file/machine_file.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/diagnose_output.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/diagnose/reference/reference_diagnosis.hpp"
#include "host/identify/friction_curves.hpp"

namespace stiction::host {

void diagnose_from_reference(const DiagnoseReferenceOptions& options, const Invocation& invocation) try {
  require_known("--reference", options.reference, "rows of the machine file", {"circle"});
  const auto machine = options.machine.load(options.machine.machine, "circle", needs_of("diagnose --reference circle"));
  Verdict verdict;
  {
    Progress progress("diagnosis", 10);  // the extension, four causes an axis, five feeds left out
    verdict = diagnose_reference(machine, [&] { progress.add(); });
  }
  put_out({verdict}, machine, {machine::find_machine(options.machine.machine), options.machine.set}, options.out,
          options.json, invocation, report_origin(options.machine.machine));
} catch (const MissingRows& error) {
  throw UsageError(fmt::format("{}: {}", machine::find_machine(options.machine.machine).string(), error.what()));
}

}  // namespace stiction::host
