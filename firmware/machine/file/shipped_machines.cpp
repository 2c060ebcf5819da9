#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <set>
#include <sstream>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/nearest_name.hpp"

namespace stiction::machine {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path>& added_folders() {
  static std::vector<fs::path> all;
  return all;
}

std::vector<fs::path> folders() {
  std::vector<fs::path> found;
  if (const char* variable = std::getenv("STICTION_MACHINES")) {
    std::istringstream list(variable);
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) found.emplace_back(folder);
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) found.push_back(program.parent_path().parent_path() / "share" / "stiction" / "machines");
  found.insert(found.end(), added_folders().begin(), added_folders().end());
  return found;
}

}  // namespace

void add_machine_folder(const fs::path& folder) { added_folders().push_back(folder); }

std::vector<std::string> shipped_machines() {
  std::set<std::string> names;
  for (const fs::path& folder : folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  }
  return {names.begin(), names.end()};
}

std::filesystem::path find_machine(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  std::error_code error;
  const bool exists = fs::exists(path, error) && !fs::is_directory(path, error);
  if (exists || path.extension() == ".toml" || name_or_path.find('/') != std::string::npos) return path;
  for (const fs::path& folder : folders()) {
    const fs::path candidate = folder / (name_or_path + ".toml");
    if (!name_or_path.empty() && fs::exists(candidate, error)) return candidate;
  }
  const std::vector<std::string> shipped = shipped_machines();
  throw MachineFileError(
      fmt::format("machine \"{}\": found {}; expected the path of a file or the name of a shipped machine: {}{}",
                  name_or_path, fs::is_directory(path, error) ? "a folder" : "no such machine",
                  shipped.empty() ? "none found" : fmt::format("{}", fmt::join(shipped, ", ")),
                  did_you_mean(name_or_path, {shipped.begin(), shipped.end()})));
}

}  // namespace stiction::machine
