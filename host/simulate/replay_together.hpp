// Many replays at once, in the lanes of batches (host/batch) on all cores.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::host {

// The set-points of this log over this machine.
struct ReplayOf {
  const machine::Machine* machine;
  const Log* log;
};
using Replayed = std::variant<Log, FaultTripped>;

// Each of `which` as replay_linear() has it, in their order: of one axis with the cascade in double precision, of other
// machines as replay_linear_as_held(). A run that trips is its fault, and the others go on. Throws LogError,
// sim::ConfigurationError and EffectError as these do.
std::vector<Replayed> replay_together(std::span<const ReplayOf> which);

}  // namespace stiction::host
