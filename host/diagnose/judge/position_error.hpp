// Simulated against measured positions of held-out logs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/diagnose/record/disturbance.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

using Positions = std::vector<std::vector<double>>;  // m, of each log at its samples

// The sample of a `log` from which positions are compared: before it contact and loop come from an unknown state.
std::size_t first_compared(const Log& log);

// m rms and m, over all `logs`: the difference of the positions `a` and `b` of their samples.
double difference_rms(const Positions& a, const Positions& b, const std::vector<Log>& logs);
double largest_difference(const Positions& a, const Positions& b, const std::vector<Log>& logs);

// The `setup` of a machine with the effects of `findings` on their axes.
ReplaySetup extended_setup(ReplaySetup setup, const std::vector<Finding>& findings);

// Simulated positions of `setup` under a draw of the `disturbance`, one of many by `seed`; nothing where the machine
// cannot follow.
std::optional<Positions> positions_under(const Disturbance& disturbance, ReplaySetup setup, std::uint64_t seed);

}  // namespace stiction::host
