// Where a shared library finds the machines that ship with it: its programme is somebody else's.
#pragma once

namespace stiction::host {

// Adds share/stiction/machines in the folder of the library that has the function at `code`, or in one of those above
// it, the nearest first, to the folders of machines (machine::add_machine_folder).
void add_machines_of_library(const void* code);

}  // namespace stiction::host
