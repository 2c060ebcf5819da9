#include "host/requests/fleet_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "firmware/machine/file/whole_file.hpp"
#include "host/fleet/results.hpp"
#include "host/report/fleet_report.hpp"
#include "host/requests/usage_error.hpp"
#include "host/sweep/run.hpp"

namespace stiction::host {
namespace {

FleetFound judged_fleet(const FleetRequest& request, const FleetHooks& hooks) {
  auto list = read_fleet_list(request.list);
  const FleetFolder folder(request.out);
  if (hooks.begin) hooks.begin();
  FleetSettings settings;
  settings.version = hooks.version;
  settings.threads =
      request.threads > 0 ? static_cast<unsigned>(request.threads) : std::max(std::thread::hardware_concurrency(), 1U);
  settings.false_alarms = request.false_alarms;
  settings.diagnose_alarms = !request.without_diagnosis;
  settings.diagnose_all = request.full;
  settings.progress = hooks.progress;
  FleetFound found{run_fleet(std::move(list), folder, settings), {}};
  found.document = fleet_json(found.result);
  put_file(folder.path() / "fleet.csv", fleet_csv(found.result));
  write_fleet_npz(found.result, folder.path() / "fleet.npz");
  put_file(folder.path() / "report.html", fleet_report_html({hooks.command_line, hooks.version, found.result}));
  put_file(folder.path() / "fleet.json", found.document.dump(2) + "\n");
  return found;
}

}  // namespace

FleetFound fleet_request(const FleetRequest& request, const FleetHooks& hooks) {
  if (request.full && request.without_diagnosis)
    throw UsageError("full: found it together with no diagnosis; expected one of them");
  if (!(request.false_alarms >= 1e-6 && request.false_alarms <= 1.0))
    throw UsageError(
        fmt::format("false alarms: found {:g} an axis in a year; expected 1e-6 to 1", request.false_alarms));
  try {
    return judged_fleet(request, hooks);
  } catch (const machine::UnreadableFile& error) {
    throw UsageError(error.what());
  }
}

}  // namespace stiction::host
