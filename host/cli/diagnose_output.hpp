// What `stiction diagnose` leaves behind, from logs and from rows alike.
#pragma once

#include <string>

#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

// Writes verdict.json, extended.toml, report.html and, where something is open that a motion answers, the set-points of
// the next measurement into `out` (empty: nothing) and prints the verdict, as JSON or for
// readers. The extended file is read back before anything appears. `machine`: as read; `options`: its name and
// overrides; `invocation`: command line and version; `origin`: machine file and logs, for the report.
void put_out(const Verdict& verdict, const machine::Machine& machine, const MachineOptions& options,
             const std::string& out, bool json, const Invocation& invocation, const Origin& origin);

}  // namespace stiction::host
