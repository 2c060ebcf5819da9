// What to record next where causes cannot be told apart, or one is not quite significant: every trajectory of
// sim/experiment/separating_trajectories.hpp is run on the machine file's simulation, and the one whose record is
// expected to separate them best (separation.hpp) is proposed, as set-points that can be run. Where the records are of
// an axis that follows a cam, the trajectories are the cams of sim/cam/separating_cams.hpp, and what is proposed is a
// motion file with a speed of the master.
#pragma once

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// A finished search with its records.
struct Searched {
  const machine::Machine& machine;
  std::size_t axis;  // of the machine
  const SignalSettings& settings;
  const std::vector<Log>& logs;   // of the rows, with linear channels
  const LogRows& rows;            // of the regressors
  const Eigen::VectorXd& target;  // N, residual force with the machine file
  const SearchContext& context;
  const SearchResult& found;
};

// Adds to the findings' confused_with what the search could not try on these records and what explains as much as all
// of them; sets verdict.next where something is open and `propose`. `verdict.findings` are those of found.terms, in
// that order. `searched`: what the search left open.
void propose_next_measurement(Verdict& verdict, const Searched& searched, bool propose);

}  // namespace stiction::host
