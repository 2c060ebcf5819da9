// The cycle of set-points that repeat: those of a slave behind a master that turns steadily. What was before such a
// log is then known, one cycle after the other.
#pragma once

#include <optional>
#include <vector>

#include "host/log/log.hpp"
#include "host/log/set_points.hpp"

namespace stiction::host {

// A master without its jumps from the end of a cycle to the beginning, and the length of a cycle.
struct UnwoundMaster {
  std::vector<double> turned;  // rad, from 0 at the first sample
  double cycle = 0.0;          // rad; 0: no cycle ends within it
};

// Of the positions of a `master`, rad, of a log: two at least.
UnwoundMaster unwound(const std::vector<double>& master);

struct RepeatingMotion {
  double period = 0.0;  // s, of a cycle
  double rise = 0.0;    // m, by which each cycle lies further than the one before it
};

// Of an axis in `log`, whose `channels` have its master and whose set-points are `points`. None where the master does
// not turn steadily, where it has no whole cycle, or where the set-points of one differ from those of the next.
std::optional<RepeatingMotion> repeating_motion(const Log& log, const AxisLog& channels, const SetPoints& points);

}  // namespace stiction::host
