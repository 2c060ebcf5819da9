// A command of `stiction` as one call, for who has no command line: Python, C. The document is the one that the command
// prints with --json; options have the names and the texts of the command's.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

struct Request {
  std::string command;                                         // "simulate circle"
  std::string machine;                                         // shipped, by name, or a path
  std::vector<std::string> set{};                              // "KEY=VALUE", as --set takes them
  std::vector<std::string> logs{};                             // files, of a command that reads logs
  std::vector<std::pair<std::string, std::string>> options{};  // {"feed", "16 m/min"}; of a flag {"refine", "true"}
  bool keep_logs = false;                                      // of simulations: every run as a log in memory
};

struct KeptLog {
  std::string run;  // tells several runs apart, "lugre 16 m/min ccw"
  Log log;
};

struct Answer {
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
// option or a text that is not known, machine::MachineFileError, LogError, InfeasibleMotion, FaultTripped.
Answer answer(const Request& request, const RequestProgress& progress = {});

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
