// A command of `stiction` as one call, for who has no command line: Python, C. The document is the one that the command
// prints with --json; options have the names and the texts of the command's.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

// What a force on an axis may depend on, at the beginning of a step of the plant: s, m, m/s and N; of a rotary axis
// rad, rad/s and N m.
struct AxisState {
  double time, position, velocity, motor_force;
};
using AxisForce = std::function<double(const AxisState&)>;  // N or N m, positive in the direction of the position

// A force on an axis that a caller gives. It is asked once or several times a step, from any thread: its value depends
// on the state alone. What it throws ends the request.
class WatchedForce;
struct RequestForce {
  std::string axis;
  AxisForce force;
  std::shared_ptr<WatchedForce> watch{};  // of answer() itself
};

struct Request {
  std::string command;                                         // "simulate circle"
  std::string machine;                                         // shipped, by name, or a path
  std::vector<std::string> set{};                              // "KEY=VALUE", as --set takes them
  std::vector<std::string> logs{};                             // files, of a command that reads logs
  std::vector<std::pair<std::string, std::string>> options{};  // {"feed", "16 m/min"}; of a flag {"refine", "true"}
  bool keep_logs = false;                                      // of simulations: every run as a log in memory
  std::vector<RequestForce> forces{};                          // of simulations: on the plants, with their effects
};

struct KeptLog {
  std::string run;  // tells several runs apart, "lugre 16 m/min ccw"
  Log log;
};

struct RequestAnswer {
  nlohmann::ordered_json document;
  std::vector<KeptLog> logs{};
};

// Told what is being done or was done, from any thread. What it throws ends the request and leaves answer().
using RequestProgress = std::function<void(std::string_view)>;

// Names of the commands that can be asked for.
std::vector<std::string> request_commands();

// Names of the options of `command`, one of request_commands().
std::vector<std::string> request_options(const std::string& command);

// Runs `request`. `progress` may be empty. Throws what the command's own functions throw: UsageError for a command, an
// option or a text that is not known, for a force that no plant of the command has, machine::MachineFileError,
// LogError, InfeasibleMotion, FaultTripped.
RequestAnswer answer(const Request& request, const RequestProgress& progress = {});

// Columns of a log in the order of its file: name ("X.x"), unit ("m"), values.
struct LogColumn {
  std::string name;
  const char* unit;
  const std::vector<double>* values;
};

// Of time and every channel that `log` has, which must outlive them.
std::vector<LogColumn> columns_of(const Log& log);

// The logs of `files`, one a stretch of a record with gaps. `columns`: names and units of a table without header;
// empty: it has one. Throws LogError.
std::vector<Log> logs_of(const std::vector<std::string>& files, const std::string& columns = {});

}  // namespace stiction::host
