// The report page of an experiment other than the circle: one self-contained HTML file with its charts, its figures
// beside what the source says of them, and the machine.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "host/report/origin.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct ExperimentReport {
  std::string command;  // the command line that made it
  std::string version;  // of stiction
  machine::Machine machine;
  sim::ExperimentResult result;
  Origin origin{};  // files, sample rate, date
};

// The whole page, UTF-8. A series is drawn from at most 3000 of its points (decimate.hpp, select_extremes); every
// printed figure is that of the result. About 32 kB a series beside the chart library's 1.1 MB. Throws
// std::invalid_argument when a series' x and y differ in length.
std::string experiment_report_html(const ExperimentReport& report);

}  // namespace stiction::host
