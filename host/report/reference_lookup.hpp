// The published and measured circle rows of a machine, looked up the way reports and the command line's JSON need them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

// A feed passes through "16 m/min" and back on its way here: two feeds are the same when they agree to 0.01 %.
inline bool same_feed(double a, double b) { return std::abs(a - b) <= 1e-4 * std::max(std::abs(a), std::abs(b)); }

// The measured row of `axis` at `feed` (m/s); null where the machine has none.
inline const machine::CircleReference* find_measured(const machine::Machine& machine, std::string_view axis,
                                                     double feed) {
  for (const auto& row : machine.circle_references)
    if (row.measured && row.axis == axis && same_feed(row.feed, feed)) return &row;
  return nullptr;
}

// The row that was published for a simulation of `axis` with the model `friction` at `feed` (m/s); null where the
// machine has none.
inline const machine::CircleReference* find_published(const machine::Machine& machine, std::string_view axis,
                                                      std::string_view friction, double feed) {
  for (const auto& row : machine.circle_references)
    if (!row.measured && row.axis == axis && row.friction == friction && same_feed(row.feed, feed)) return &row;
  return nullptr;
}

}  // namespace stiction::host
