// The keys of all friction laws and effects that the simulation knows, as data without a law (generated, see
// sim/vocabulary): for programmes that read machine files but simulate nothing.
#pragma once

#include "firmware/machine/model/value_table.hpp"

namespace stiction::machine {

const Vocabulary& shipped_vocabulary();

}  // namespace stiction::machine
