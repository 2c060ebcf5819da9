// The rows of a sweep: each is computed from its number alone, and knows the command that runs it by itself.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/sweep/spec.hpp"

namespace stiction::host {

struct SweepCommand;
class MachineValues;

struct SweepRow {
  std::string machine;
  std::vector<std::string> logs;
  std::vector<std::pair<std::string, std::string>> options;  // name without hyphens, value
  std::vector<std::string> set;                              // KEY=VALUE, for `--set`
  // Of each key of the specification: its value as a number in the unit of its column (NaN for texts) and as a text.
  std::vector<double> numbers;
  std::vector<std::string> texts;

  // The value of option `name`; `fallback` where the row has none.
  std::string option(std::string_view name, const std::string& fallback = {}) const;
};

class SweepRows {
 public:
  // `spec`, which must stay as long as this does, with `command` of the table. Reads the machine files where keys are
  // relative to their values. Throws machine::MachineFileError.
  SweepRows(const SweepSpec& spec, const SweepCommand& command);
  ~SweepRows();

  std::uint64_t size() const { return size_; }

  // Row `index`, below size(). The draws go fastest, then the last key of the specification.
  SweepRow row(std::uint64_t index) const;

  // The numbers and texts of row `index` alone.
  SweepRow values(std::uint64_t index) const;

  // The command line that repeats `row`, for a shell.
  std::string command_line(const SweepRow& row) const;

 private:
  const SweepSpec& spec_;
  const SweepCommand& command_;
  std::uint64_t size_;
  std::map<std::string, std::unique_ptr<MachineValues>> machines_;  // by name; of relative keys alone
};

}  // namespace stiction::host
