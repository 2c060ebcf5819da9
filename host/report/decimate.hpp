// Fewer samples of a lap for drawing, none of them invented: a subset of the recorded instants, the same for all
// channels, that keeps what the eye reads from the full record.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stiction::host {

// Rising indices of at most `limit` instants of the lap. `angle` (rad) turns one way, wrapped or not; all channels have
// its length. Kept: the first and last instant, the largest and smallest value of each channel, and in each of as
// many bins as fit the value of each channel that lies farthest from its mean in the bin. The bins narrow towards
// the reversals (multiples of 90 degrees), where the quadrant glitches are. A lap within the limit is kept
// whole. Throws std::invalid_argument when a length differs or `limit` is below three instants a channel plus two.
std::vector<std::size_t> select_instants(std::span<const double> angle,
                                         std::span<const std::span<const double>> channels, std::size_t limit);

}  // namespace stiction::host
