// An effect drawn from a seed, for the demonstration: what a machine has and its file does not. The simulated machine
// and the diagnosis take its law from the same files, so this shows how a diagnosis reads; what it is worth is measured
// with a truth that shares no code with the engine (tests/blind).
#pragma once

#include <cstdint>

#include "firmware/machine/model/effect.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

// One of the effects that the axis can have, of a strength that a careful record shows: equal chances for all.
machine::Effect draw_hidden_effect(const machine::AxisModel& axis, std::uint64_t seed);

}  // namespace stiction::host
