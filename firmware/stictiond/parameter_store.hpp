// The parameters of a drive on its disk: what was set on the machine beyond its machine file. A set is written whole or
// not at all, whenever the power goes: a new file beside the old one, brought to the disk, takes its name, and the
// folder is brought to the disk. The set before stays as FILE.previous.
//
// The text "stiction.parameters/1", with an example: docs/formats.md, "Parameter store".
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "firmware/stictiond/file_operations.hpp"

namespace stiction::drive {

struct ParameterSet {
  std::string machine;                   // id of the machine file that they belong to
  std::map<std::string, double> values;  // by key, "axis.X.position_controller.gain", SI units
  bool operator==(const ParameterSet&) const = default;
};

// Fault::parameters_damaged: nothing of the file may be used. what() says what was found and what was expected.
class ParametersDamaged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The bytes of a file. Throws std::invalid_argument where a name has a space or a value is not a finite number.
std::string encode(const ParameterSet& set);

// The whole set, or ParametersDamaged. `file` is the name shown in messages.
ParameterSet decode(std::string_view bytes, const std::string& file);

// None where there is no file: the machine file alone holds. Throws ParametersDamaged and std::system_error.
std::optional<ParameterSet> read_parameters(const std::filesystem::path& file, FileOperations& files = system_files());

// What FILE.previous is after a write: the file of before, or what it was already, as the file was refused.
enum class KeepAsPrevious { the_file, what_is_there };

// Returns when the set is on the disk. One writer at a time. Throws std::system_error; the old set then still holds.
// `file`: of the set; `set`: to write; `keep`: the set before; `files`: operations of the file system, which tests
// interrupt.
void write_parameters(const std::filesystem::path& file, const ParameterSet& set,
                      KeepAsPrevious keep = KeepAsPrevious::the_file, FileOperations& files = system_files());

// Where the set before is kept.
std::filesystem::path previous_of(const std::filesystem::path& file);

}  // namespace stiction::drive
