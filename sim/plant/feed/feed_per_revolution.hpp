// Feed per revolution of the spindle from the carriage's travel (Kudoyarov et al., section 3: the pulse of feed is cut
// into periods of the spindle).
#pragma once

#include <vector>

#include "sim/plant/feed/stick_slip_feed.hpp"

namespace stiction::sim {

// Travel (m) in each of `count` revolutions of `period` s, counted from `origin` (s). `run` stands at its beginning, or
// at least before `origin`; afterwards at the end of the last revolution.
inline std::vector<double> feed_per_revolution(StickSlipFeed& run, double origin, double period, std::size_t count) {
  std::vector<double> feeds;
  run.advance_to(origin);
  double before = run.state()[feed_state::travel];
  for (std::size_t i = 1; i <= count; ++i) {
    run.advance_to(origin + static_cast<double>(i) * period);
    feeds.push_back(run.state()[feed_state::travel] - before);
    before = run.state()[feed_state::travel];
  }
  return feeds;
}

}  // namespace stiction::sim
