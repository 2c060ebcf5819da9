// The separating trajectories within what an axis and its records allow, run on the machine file's simulation.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/classes/candidate.hpp"
#include "host/identify/log_rows.hpp"
#include "sim/experiment/separating_trajectories.hpp"

namespace stiction::host {

// In a scene: no candidate is left out for want of reversals.
inline constexpr int enough_reversals = 1000;

// Within the positions that the records cover; where these are less than a quarter of the travel, that much about their
// middle. Nine tenths of the axis' speed. Accelerations are half as high again as in the records; where they are what
// is looked at, 0.7 of the axis' and what half of its motor's force gives.
sim::MotionRange motion_range(const machine::AxisModel& axis, const LogRows& rows);
// Where a proposed log begins, how far and how fast it goes, in the `units` of the axis, and a warning where the
// records in the `rows` did not go there.
std::string extent_words(const Log& proposed, const LogRows& rows, const ShownUnits& units);

struct Rehearsal {
  const sim::SeparatingTrajectory* trajectory;
  Log log;                // x_set, v_set, a_set, x and the motor's current or voltage, as simulated
  LogRows rows;           // of its motion
  SearchContext context;  // of the present records, with this one's extent
};

// Those that the machine follows in simulation, at the rate that gives rows like those of `rows`. `axis` as the file
// has it, `range` of positions (m), `context` of the search, `settings` of the rows.
std::vector<Rehearsal> rehearse(const machine::Machine& machine, std::size_t axis, const sim::MotionRange& range,
                                const LogRows& rows, const SearchContext& context, const SignalSettings& settings);

}  // namespace stiction::host
