// The pictures of a verdict: the residual force before and after, over time, position, speed and frequency; of each
// cause the residual that it explains, over what it depends on.
#pragma once

#include <Eigen/Dense>

#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// "velocity, mm/s": of what `shown` shows, with the squares of its unit as a page prints them.
std::string axis_label(std::string_view quantity, const ShownQuantity& shown);

// `before`, `after`: residual force in the rows (N), with the file's machine and with all causes. `verdict`: to which
// they are added.
void add_charts(Verdict& verdict, const LogRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after);

// To each finding: the residual with all other causes taken out, beside what the cause makes of it (a partial residual
// plot: Larsen and McCleary 1972), over position, speed, way since the last reversal, or whatever the cause depends on.
// `terms` in the order of the findings, of the rows whose residual is `after`. `verdict`: with the findings; `context`:
// of the search.
void add_cause_charts(Verdict& verdict, const LogRows& rows, const SearchContext& context,
                      const std::vector<Term>& terms, const Eigen::VectorXd& after);

}  // namespace stiction::host
