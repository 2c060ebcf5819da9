// The text of a machine file with other values: what identification and diagnosis leave behind. Values are replaced in
// the tree of the file and the tree is written anew: comments of the file are not kept, nor the figures expected of the
// machine before ([[expected]]).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace stiction::machine {

// A value for a key, in the spelling of a machine file: a plain number, a quantity or name as text, or a list of
// quantities; std::monostate removes the key, or the table, if it is there. A "*" in the path stands for every key.
struct MachineEdit {
  std::vector<std::string> path;  // "axis", "X", "mass"
  std::variant<std::monostate, double, std::string, std::vector<std::string>> value;
};

// `set`: assignments as on the command line (ReadOptions), made before the edits. `comment`: lines for the head of the
// file, without "#". Throws MachineFileError.
std::string edited_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                           std::span<const MachineEdit> edits, std::span<const std::string> comment);

// "225.124 kg": seven digits, more than any interval is narrow.
std::string written_quantity(double value, std::string_view unit);

}  // namespace stiction::machine
