// What a diagnosis is asked.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// What a diagnosis does, one after the other; the last only where the others leave something without a name.
inline constexpr std::array<std::string_view, 7> diagnosis_parts{
    "simulated motion", "selection",    "refinement in closed loop", "held-out data", "next measurement",
    "closed loop",      "faster forces"};

struct DiagnoseInput {
  machine::Machine machine;
  std::size_t axis = 0;                                 // of the machine
  std::vector<Log> logs;                                // at least one
  std::vector<Log> held_out;                            // empty: the last third of each log is held out
  std::uint64_t seed = 1;                               // of the bootstrap
  bool closed_loop = true;                              // replay the held-out logs where they have set-points
  bool next_measurement = true;                         // propose one where something is open
  std::function<void(std::string_view part)> progress;  // at the beginning of each of diagnosis_parts
};

}  // namespace stiction::host
