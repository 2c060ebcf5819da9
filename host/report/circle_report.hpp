// The report page of the circular test: one self-contained HTML file with the polar plot, the quadrants, the table
// beside published and measured rows, the terms of ISO 230-4 and the machine.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "host/report/origin.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

struct CircleReport {
  std::string title;         // "Circle: MCFV 5050 LN cross table"
  std::string command;       // the command line that made it
  std::string version;       // of stiction
  machine::Machine machine;  // its parameters and reference rows
  sim::CircleResult result;  // any number of friction models, feeds and directions; at least one run
  Origin origin{};           // files, sample rate, date
};

// The whole page, UTF-8. A lap is drawn from at most 1500 of its instants (decimate.hpp); every printed figure is that
// of the full record. About 55 kB a run beside the chart library's 1.1 MB. Throws std::invalid_argument when there is
// no run or an array of a run differs in length from its angles.
std::string circle_report_html(const CircleReport& report);

}  // namespace stiction::host
