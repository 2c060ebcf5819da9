// An effect as a machine file names it ([[axis.NAME.effect]]): what the simulation lacks or has wrong, as diagnosis
// adds it. Each kind is one file beside this one and one row of the table in effects.hpp.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace stiction::sim {

struct Effect {
  std::string name;                                   // "force_ripple"
  std::map<std::string, std::vector<double>> values;  // by key, SI; one value, or a list where the key takes one
};

}  // namespace stiction::sim
