// Reads what a machine file says to the drive's programme, its table [drive]. The keys are described in
// drive_parameters.hpp.
#pragma once

#include <filesystem>
#include <string>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

class Document;

// The table [drive] of a file whose machine was read with the same options; a file without one gives the defaults.
// Throws MachineFileError.
DriveSetup read_drive_setup(const std::filesystem::path& file, const Machine& machine, const ReadOptions& options = {});

// The same from a merged document: the reader of machines calls it too, so that a typo under [drive] is refused by
// every command.
DriveSetup drive_setup_of(const Document& document, const Machine& machine);

}  // namespace stiction::machine
