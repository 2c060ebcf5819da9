// White noise of a record's encoder beside its steps. The drive answers to it, and friction is less where it shakes the
// axis: exact machines have to have as much of it.
#pragma once

#include <optional>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// m rms: what fourth differences of the position of `logs`, which hardly know a motion, have more while the axis moves
// than those of its runs `without_noise`; their variance is 70 times that of the noise. What is far out, as a spike is,
// does not count. Both in the same order, with channels of the `axis`. Nothing where there are no runs, where they
// hardly move, or where a log is slower than 1 kHz.
std::optional<double> encoder_noise(const std::vector<Log>& logs, const std::vector<Log>& without_noise,
                                    const machine::AxisModel& axis);

}  // namespace stiction::host
