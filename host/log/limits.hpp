// Samples at which a channel stands at the end of its range and tells no more than that.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

// Why samples of a channel are left out.
struct LimitedChannel {
  const LogChannel* channel = nullptr;
  enum class Kind { limit, clipped, off } kind = Kind::limit;
  double level = 0.0;  // in the unit of the channel: the greatest magnitude among them; of `limit` the limit itself
  std::vector<bool> samples;
};

// The channels of an axis that stand at an end. The effort (the first of i, F, u that is there): at `limit` where it is
// known, else where it piles up: five or more samples, 5 ms or longer, with one and the same value within a tenth of
// the greatest magnitude, entered or left with a slope that a smooth peak of this length would not have, while the
// controller's input (the error of position, without set-points the speed) changes. A
// voltage of exactly 0 for 0.1 s while the axis moves: the drive is off. The position: where it stops within one sample
// from more than a tenth of its greatest speed at the end of its range. `log`: even, with its period; `axis`: of it;
// `limit`: of the effort, in its unit.
std::vector<LimitedChannel> limited_channels(const Log& log, const AxisLog& axis, std::optional<double> limit = {});

// Adds them to `axis.left_out`; returns how many samples are left out now. `axis`: of the log; `limited`: as above.
std::size_t leave_out(AxisLog& axis, const std::vector<LimitedChannel>& limited);

}  // namespace stiction::host
