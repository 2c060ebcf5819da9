// An effect as a machine file names it ([[axis.NAME.effect]]): what the simulation lacks or has wrong, as diagnosis
// adds it. What each name means is known to the simulation alone.
#pragma once

#include <string>

#include "firmware/machine/model/value_table.hpp"

namespace stiction::machine {

struct Effect {
  std::string name;  // "force_ripple"
  KeyedValues values;
};

}  // namespace stiction::machine
