// The machine that ships, read from the source tree.
#pragma once

#include <string>
#include <vector>

#include "sim/machine_file.hpp"

namespace stiction::test {

inline machine::Machine cross_table(std::vector<std::string> set = {}) {
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                           {"circle", std::move(set)});
}

}  // namespace stiction::test
