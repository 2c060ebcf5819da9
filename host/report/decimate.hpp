// Fewer samples of a record for drawing, none of them invented: a subset of the recorded instants that keeps what the
// eye reads from the full record.
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

// Rising indices of at most `limit` points of one line, which may run forth and back in x. Kept: the first and last
// point, and in each of as many bins of equal count as fit the extremes of y, those of x where x turns back, and the
// first point that is not finite, where a drawn line has its gap. A line within the limit is kept whole. Throws
// std::invalid_argument when the lengths differ or `limit` is below 7.
std::vector<std::size_t> select_extremes(std::span<const double> x, std::span<const double> y, std::size_t limit);

}  // namespace stiction::host
