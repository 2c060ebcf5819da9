// The resolution of a channel: the increment that its values are whole multiples of, and the noise that rides on it.
#pragma once

#include <span>

#include "host/log/log.hpp"

namespace stiction::host {

// The largest increment of which nine in ten differences between neighbouring values are whole multiples, within the
// digits that the values were written with (decimals, single precision): the counts of an encoder, the last bit of a
// converter, else the last decimal of the text. In the unit of the channel; 0: none found (a constant channel, or
// values in full precision). `values`: of the channel, at least eight that differ. Blank cells (NaN) are passed over.
// Takes N log N.
double increment_of(std::span<const double> values);

// The increment of one of an axis' channels as it was written, in its unit; 0: none found. After a resampling the
// values themselves no longer tell. `axis`: whose `increments` count where it has some; `channel`: one of log_channels'
// values.
double increment_of(const AxisLog& axis, std::vector<double> AxisLog::*channel);

// Standard deviation of what is random in a channel from sample to sample, its rounding included, in the unit of the
// channel: robust (median) differences of the order, from 1 to 6, that leave least of the motion. 0: too few samples
// that change. `values`: of the channel, evenly sampled. Samples at rest do not count: they hide the rounding.
double noise_of(std::span<const double> values);

}  // namespace stiction::host
