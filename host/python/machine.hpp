// A machine that Python holds: its file with the assignments made to it, and what was read of both.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::python {

struct MachineHandle {
  std::string file;
  std::vector<std::string> set;  // "KEY=VALUE"
  machine::Machine machine;
};

}  // namespace stiction::python
