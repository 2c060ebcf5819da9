// What `stiction diagnose` leaves behind, from logs and from rows alike.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

// The machine file that was diagnosed: it becomes extended.toml.
struct DiagnosedFile {
  std::filesystem::path file;
  std::vector<std::string> set;  // assignments of the command line that it does not hold yet
};

// Writes verdict.json, extended.toml, report.html and, where something is open that a motion answers, the set-points of
// the next measurement into `out` (empty: nothing) and prints the verdict, as JSON or for readers. Of several axes each
// has a page report_AXIS.html, and report.html leads to them. The extended file is read back before anything appears.
// `verdicts`: one an axis; `machine`: as it was diagnosed, from `file`; `invocation`: command line and version;
// `origin`: machine file and logs, for the report.
void put_out(const std::vector<Verdict>& verdicts, const machine::Machine& machine, const DiagnosedFile& file,
             const std::string& out, bool json, const Invocation& invocation, const Origin& origin);

}  // namespace stiction::host
