// The options of `stiction-plant`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "host/plant/can_nodes.hpp"

namespace stiction::host {

// A value of an option that cannot be. what() names the option, what was found and what was expected.
class PlantOptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PlantOptions {
  std::string machine, experiment, bus, fault_every;
  std::vector<std::string> set, at, marks, faults;
  std::uint64_t seed = 1;

  void add_to(CLI::App& program);
};

// The bus of the options: its kind, "can", "modbus" or "gpio", and its name. Throws PlantOptionError.
struct PlantBus {
  std::string kind, name;
};
PlantBus bus_of(const PlantOptions& options);

// Where the axes stand at the start (m), from "X=90 mm"; 0 where nothing is said. Throws PlantOptionError.
std::vector<double> start_positions(const PlantOptions& options, const machine::Machine& machine);

// Where switches and index marks are, from "X.index=100 mm"; one an axis. Throws PlantOptionError.
std::vector<hal::AxisMarks> marks_of(const PlantOptions& options, const machine::Machine& machine);

// The faults of the options, each at its time or at random times. Throws PlantOptionError.
FaultSchedule faults_of(const PlantOptions& options, const machine::Machine& machine);

// The nodes as the machine file has them, on the bus of the options. Throws PlantOptionError. `options`: with the
// interface; `machine`: whose axes are the nodes; `setup`: node numbers and bit rates of the machine file.
CanNodesConfig can_nodes_config(const PlantOptions& options, const machine::Machine& machine,
                                const machine::DriveSetup& setup);

}  // namespace stiction::host
