// Where a report comes from: the date, the machine and its file, the source files, their sample rate, the command line
// and the version that made it.
#pragma once

#include <string>
#include <vector>

namespace stiction::host {

// What logs together can determine of one axis, by inspection of each (host/log/inspection.hpp).
struct AxisAbility {
  struct Open {
    std::string what, reason, record;  // clauses: why not, and what to record instead
  };
  std::string axis;  // empty: of logs without axis names
  std::vector<std::string> possible;
  std::vector<Open> open;
  std::vector<std::string> suspicions;
};

// What a command knows of its input, beside the machine itself.
struct Origin {
  std::vector<std::string> machine_files{};  // as they were found; empty: not known
  std::vector<std::string> sources{};        // files that were read; empty: a simulation alone
  std::vector<double> sample_periods{};      // s, of the sources or of the simulation; empty: none
  std::string date{};                        // "2026-11-23 15:41 UTC"; empty: the time at which the page is made
  std::vector<AxisAbility> abilities{};      // of the sources, where they are logs
};

// The present time as "2026-11-23 15:41 UTC", or that of the environment's SOURCE_DATE_EPOCH, for builds that must be
// reproduced.
std::string present_date();

// Items <div><dt><dd> for the list in a page's head. `origin`: as above; `machine`: its name; `command`: the command
// line that made the page; `version`: of stiction. All as plain text.
std::string origin_html(const Origin& origin, const std::string& machine, const std::string& command,
                        const std::string& version);

// What the logs can and cannot determine, as HTML; empty without logs. `origin`: as above.
std::string abilities_html(const Origin& origin);

// "16 kHz (62.5 µs)", several with ", " between them. `periods`: s, above zero.
std::string sample_rates(const std::vector<double>& periods);

}  // namespace stiction::host
