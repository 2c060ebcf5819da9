// Reads a machine from its TOML file ("stiction.machine/1"). The keys are described in parameters.hpp; the README's
// section "Machine file" and `stiction machine --reference` show them to users.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/value_table.hpp"

namespace stiction::machine {

// what() is "FILE:LINE: KEY: found ...; expected ...". For a value from the command line the place is "--set KEY", for
// one from [experiment.NAME] the line of the override, with the key as it stands there.
class MachineFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ReadOptions {
  std::string experiment;        // merges [experiment.NAME], if the file has it
  std::vector<std::string> set;  // "axis.X.mass=230 kg", merged in order after the experiment
  bool all_errors = false;       // of the file as it is: what() has a line for each, in place of the first alone
};

// The machine of a file, checked: every table of it, also friction models that are not in use and the overrides of
// every experiment. `vocabulary`: what stands in the tables of friction models and effects. Throws MachineFileError.
// `options`: an experiment and assignments to merge before.
Machine read_machine(const std::filesystem::path& file, const Vocabulary& vocabulary, const ReadOptions& options = {});

// The same from a text; `file` is the name shown in messages. `text`: the content; `vocabulary` and `options` as above.
Machine parse_machine(const std::string& file, const std::string& text, const Vocabulary& vocabulary,
                      const ReadOptions& options = {});

// The text of a file. Throws MachineFileError when it cannot be read.
std::string content_of(const std::filesystem::path& file);

// The file of a machine named on the command line: a path, or the name of a shipped machine, looked up in the folders
// of $STICTION_MACHINES (separated by ':') and in ../share/stiction/machines beside the program. Throws
// MachineFileError with the machines found.
std::filesystem::path find_machine(const std::string& name_or_path);

// Machines are looked for in `folder` too, after all others: of a library whose program is somebody else's. Before any
// thread looks for a machine.
void add_machine_folder(const std::filesystem::path& folder);

// Names of the shipped machines, sorted.
std::vector<std::string> shipped_machines();

}  // namespace stiction::machine
