// Causes between motor and load, from the difference of two encoders (encoder_difference.hpp): those that the training
// records need and the held-out ones bear out.
#pragma once

#include <cstdint>
#include <vector>

#include "host/diagnose/judge/encoder_difference.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

struct EncoderCauses {
  std::vector<Finding> findings;  // with evidence, figures of held-out data and charts
  std::vector<Rejected> rejected;
};

// `training` and `held_out` records of `axis` (the file's); `units`: in which it is shown; `seed` of the bootstrap.
EncoderCauses find_between_encoders(const EncoderDifference& training, const EncoderDifference& held_out,
                                    const machine::AxisModel& axis, const ShownUnits& units, std::uint64_t seed);

}  // namespace stiction::host
