#include "host/requests/library_folder.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "firmware/machine/file/machine_file.hpp"

namespace stiction::host {

void add_machines_of_library(const void* code) {
  namespace fs = std::filesystem;
  Dl_info library{};
  if (dladdr(code, &library) == 0 || library.dli_fname == nullptr) return;
  std::error_code error;
  for (auto folder = fs::canonical(library.dli_fname, error).parent_path(); !folder.empty();
       folder = folder.parent_path()) {
    const auto machines = folder / "share" / "stiction" / "machines";
    if (fs::is_directory(machines, error)) return machine::add_machine_folder(machines);
    if (folder == folder.root_path()) return;
  }
}

}  // namespace stiction::host
