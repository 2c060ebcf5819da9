// Everything that the loop is built from, read and checked before anything is opened.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "firmware/stictiond/options.hpp"
#include "firmware/stictiond/parameter_store.hpp"
#include "hal/bus_budget.hpp"
#include "hal/can/can_backend.hpp"
#include "hal/can/dbc.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/drive/servo_drive.hpp"
#include "stiction/drive/ticker.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::drive {

// The start is refused. what() says what was found, what was expected and what to do.
class StartRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DriveConfiguration {
  std::filesystem::path file;            // of the machine
  std::vector<std::string> assignments;  // over it, from the command line
  std::optional<ParameterSet> stored;    // over it as well: what was stored on this machine
  // Why the file of the parameters was not used; `stored` is then the set before it. The axes stay off, fault 50.
  std::optional<std::string> rejected_parameters;
  machine::Machine machine;
  machine::DriveSetup setup;
  std::vector<std::string> names;  // of the axes
  std::vector<AxisConfig<FixedSignals>> axes;
  std::vector<ServoDriveConfig<FixedSignals>> drives;
  std::vector<FrictionCompensationConfig<FixedSignals>> compensations;
  std::int64_t period_ns;
  Ticker ticker;
};

// Where the parameters of this machine are stored; empty without --parameters.
std::filesystem::path parameter_file(const DriveOptions& options);

// Reads the machine file, and over it the parameters stored on this machine; where these are damaged or would refuse
// the start, those before them. Throws StartRefused, machine::MachineFileError, machine::ConfigurationError.
DriveConfiguration read_configuration(const DriveOptions& options);

// Builds all that a start with a set builds, and throws what would refuse it. `options`: of the start; `set`: in the
// place of the stored one.
void check_whole(const DriveOptions& options, const ParameterSet& set);

// Throw StartRefused where the machine file does not say what the bus needs.
hal::can::CanBackendConfig can_config(const DriveConfiguration& configuration);
// The frames of [drive.can] and [drive.can_server] as a DBC file; throws where there is neither.
std::string dbc_page(const DriveConfiguration& configuration);

// What the CAN bus has to carry.
hal::BusBudget can_bus_budget(const DriveConfiguration& configuration);

}  // namespace stiction::drive
