// A shaft whose ends are both recorded: what differs between motor and load is found from the difference of the two
// encoders before anything is looked for in the residual force, which the shaft's vibration is in as well.
#pragma once

#include <optional>

#include "host/diagnose/judge/encoder_causes.hpp"
#include "host/diagnose/prepare.hpp"

namespace stiction::host {

struct BetweenEncoders {
  EncoderCauses causes;
  std::optional<DiagnoseInput> input;  // with what was found in its machine; none: nothing was
};

// `input` of the diagnosis; `prepared` from it. Throws LogError.
BetweenEncoders between_encoders(const DiagnoseInput& input, const Prepared& prepared);

}  // namespace stiction::host
