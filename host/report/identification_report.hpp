// The report page of an identification: the friction characteristic with what was measured, the curve and its band; the
// residual over time and speed; the parameters with their intervals; what the data could not determine.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/identification.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

struct IdentificationReport {
  std::string command;  // the command line that made it
  std::string version;  // of stiction
  machine::Machine machine;
  Identification result;
  Origin origin{};  // files, sample rate, date
};

// The whole page, UTF-8. The residual of each log is drawn from at most 3000 of its rows (decimate.hpp).
std::string identification_report_html(const IdentificationReport& report);

}  // namespace stiction::host
