// The separating trajectories within what an axis and its records allow, run on the machine file's simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/verdict/verdict.hpp"
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
  std::string name, words;         // of the motion, and what it shows
  std::optional<ProposedCam> cam;  // that makes it; none: it is made of set-points alone
  Log log;                         // x_set, v_set, a_set, x and the motor's current or voltage, as simulated
  LogRows rows;                    // of its motion
  SearchContext context;           // of the present records, with this one's extent
};

// What an axis is rehearsed on: `machine` with its axis of that index alone, whose encoder has no noise.
machine::Machine rehearsal_machine(const machine::Machine& machine, std::size_t axis);
// s, from sample to sample of a log that gives rows like those of `rows`.
double rehearsal_period(const LogRows& rows);
// Of the motion in `set_points`, a log of linear channels of the only axis of `setup`; none: the machine does not
// follow it. `context` of the search, `settings` of the rows. Without name, words and cam.
std::optional<Rehearsal> rehearsed(const machine::Machine& setup, const Log& set_points, const SearchContext& context,
                                   const SignalSettings& settings);

// Those that the machine follows in simulation, at the rate that gives rows like those of `rows`. `axis` as the file
// has it, `range` of positions (m), `context` of the search, `settings` of the rows.
std::vector<Rehearsal> rehearse(const machine::Machine& machine, std::size_t axis, const sim::MotionRange& range,
                                const LogRows& rows, const SearchContext& context, const SignalSettings& settings);

}  // namespace stiction::host
