// The report page of a diagnosis: measured against simulated, before and after; each cause with its value, evidence,
// effect on the part, what it may be confused with and what to do; what was rejected; what remains unexplained.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

struct DiagnosisReport {
  std::string command;  // the command line that made it
  std::string version;  // of stiction
  machine::Machine machine;
  Verdict verdict;
  Origin origin{};       // files, sample rate, date
  std::string suffix{};  // of the names of its files: its axis where there are several; empty: the only one
};

// The whole page, UTF-8; one file that loads nothing. Throws std::invalid_argument when a series' x and y differ in
// length.
std::string diagnosis_report_html(const DiagnosisReport& report);

// "report.html", or "report_X.html" of one of several axes. `axis`: its name; empty: the only one.
std::string diagnosis_page_of(const std::string& axis);

// The page that leads to those of several axes. `verdicts`: one an axis; `frame`: all but the verdict.
std::string diagnosed_axes_html(const std::vector<Verdict>& verdicts, const DiagnosisReport& frame);

}  // namespace stiction::host
