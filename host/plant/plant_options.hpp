// The options of `stiction-plant`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/plant/can_nodes.hpp"
#include "sim/model/drive_setup.hpp"
#include "sim/model/machine.hpp"

namespace stiction::host {

// A value of an option that cannot be. what() names the option, what was found and what was expected.
class PlantOptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PlantOptions {
  std::string machine, experiment, bus;
  std::vector<std::string> set, at, faults;
  std::uint64_t seed = 1;

  void add_to(CLI::App& program);
};

// The bus of the options: its kind, "can" or "modbus", and its name. Throws PlantOptionError.
struct PlantBus {
  std::string kind, name;
};
PlantBus bus_of(const PlantOptions& options);

// Where the axes stand at the start (m), from "X=90 mm"; 0 where nothing is said. Throws PlantOptionError.
std::vector<double> start_positions(const sim::Machine& machine, const std::vector<std::string>& at);

// The faults of the options. Throws PlantOptionError.
std::vector<PlantFault> faults_of(const PlantOptions& options, const sim::Machine& machine);

// The nodes as the machine file has them, on the bus and with the faults of the options. Throws PlantOptionError.
CanNodesConfig can_nodes_config(const PlantOptions& options, const sim::Machine& machine, const sim::DriveSetup& setup);

}  // namespace stiction::host
