// The page of a step cam: one self-contained HTML file with the mechanism at any angle of the cam, what each of its
// contacts carries there, and charts over a turn.
#pragma once

#include <string>
#include <vector>

#include "host/cam/step/result.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

struct StepCamReport {
  std::string command;  // the command line that made it
  std::string version;  // of stiction
  const step::StepProject& project;
  const step::StepSynthesis& made;        // of that project
  std::vector<step::StepFigure> figures;  // that the command prints
  Origin origin{};                        // source files, date
};

// The whole page, UTF-8. A turn is shown at up to 1800 angles of the cam, profiles by as many points; about 0.6 MB with
// the chart library's 1.1 MB besides.
std::string step_cam_report_html(const StepCamReport& report);

}  // namespace stiction::host
