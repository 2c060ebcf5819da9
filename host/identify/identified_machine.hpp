// identified.toml: the machine file with what identification determined in place of what stood there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/identify/identification.hpp"

namespace stiction::host {

// The text of a valid machine file. Mass and friction of the axis are replaced; a friction model of which a key was not
// determined is left out, and so are the overrides of experiments for what was replaced; the head of the file names
// what was found, what was left out and what stays as it was. `set`: assignments of the command line. Throws LogError
// when no friction model is left, sim::MachineFileError. `file`: the machine file; `axis`: that was identified;
// `result`: its parameters; `command`: the command line, for the head of the file.
std::string identified_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                               const machine::AxisModel& axis, const Identification& result,
                               const std::string& command);

}  // namespace stiction::host
