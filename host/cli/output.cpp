#include "host/cli/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "host/cli/errors.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

// One of them marks a folder as a result, so that only results are ever replaced.
constexpr std::array markers{"result.json", "verdict.json"};

bool is_result(const fs::path& folder) {
  return std::any_of(markers.begin(), markers.end(), [&](const char* marker) { return fs::exists(folder / marker); });
}

fs::path pending_name(const fs::path& place) {
  // A trailing slash leaves an empty file name.
  fs::path plain = place.lexically_normal();
  if (plain.filename().empty()) plain = plain.parent_path();
  return plain.parent_path() / ("." + plain.filename().string() + ".partial-" + std::to_string(::getpid()));
}

[[noreturn]] void fail(const fs::path& place, const char* what) {
  throw std::runtime_error(place.string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace

PendingFile::PendingFile(fs::path place) : place_(std::move(place)), pending_(pending_name(place_)) {
  if (fs::is_directory(place_)) throw UsageError(place_.string() + ": found a folder; expected the name of a file");
}
PendingFile::~PendingFile() {
  std::error_code ignored;
  fs::remove(pending_, ignored);
}
void PendingFile::commit() {
  if (std::rename(pending_.c_str(), place_.c_str()) != 0) fail(place_, "cannot be written");
}

PendingFolder::PendingFolder(fs::path place) : place_(std::move(place)), pending_(pending_name(place_)) {
  if (fs::exists(place_) && !fs::is_directory(place_))
    throw UsageError(place_.string() + ": found a file; expected a folder for the results");
  if (fs::exists(place_) && !fs::is_empty(place_) && !is_result(place_))
    throw UsageError(place_.string() +
                     ": found a folder with other files; expected a new or empty folder, or an earlier result (with "
                     "result.json or verdict.json), which is replaced");
  std::error_code error;
  fs::create_directories(pending_, error);
  if (error) throw UsageError(place_.string() + ": cannot be created: " + error.message());
}
PendingFolder::~PendingFolder() {
  std::error_code ignored;
  fs::remove_all(pending_, ignored);
}
void PendingFolder::write(std::string_view name, std::string_view content) const {
  std::ofstream file(pending_ / name, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) fail(pending_ / name, "cannot be written");
}
void PendingFolder::commit() {
  if (::rename(pending_.c_str(), place_.c_str()) == 0) return;  // new, or over an empty folder
  // Exchange puts the new result in place and the old one under the temporary name, which the destructor removes.
  if (::renameat2(AT_FDCWD, pending_.c_str(), AT_FDCWD, place_.c_str(), RENAME_EXCHANGE) != 0)
    fail(place_, "cannot be replaced");
}

}  // namespace stiction::host
