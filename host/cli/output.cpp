#include "host/cli/output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "firmware/machine/file/whole_file.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/result_record.hpp"
#include "host/cli/temporaries.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

std::error_code unimportant;

// Without a trailing slash, which leaves an empty file name.
fs::path plain(const fs::path& place) {
  const auto normal = place.lexically_normal();
  return normal.filename().empty() && normal.has_relative_path() ? normal.parent_path() : normal;
}

fs::path folder_of(const fs::path& place) {
  const auto parent = plain(place).parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

bool may_write(const fs::path& place) { return ::access(place.c_str(), W_OK) == 0; }

// Why not.
std::string lacking(const fs::path& place, const std::string& permission) {
  return ::access(place.c_str(), W_OK) != 0 && errno == EROFS ? "a read-only file system" : permission;
}

// Devices and pipes are written, not replaced.
bool is_stream(const fs::path& place) {
  return fs::exists(place, unimportant) && !fs::is_regular_file(place, unimportant) &&
         !fs::is_directory(place, unimportant);
}

std::string temporary_name(const fs::path& place) {
  return "." + plain(place).filename().string() + ".partial-" + std::to_string(::getpid());
}

std::optional<std::string> trouble_with_file(const fs::path& place) {
  const auto folder = folder_of(place);
  const auto says = [&](const std::string& text) { return fmt::format("{}: {}", place.string(), text); };
  if (place.empty()) return "found an empty name; expected that of a file";
  if (fs::is_directory(place, unimportant) || place.filename().empty())
    return says("found a folder; expected the name of a file");
  if (!fs::exists(folder, unimportant))
    return says(fmt::format("found no folder {}; expected a folder that exists", folder.string()));
  if (!fs::is_directory(folder, unimportant))
    return says(fmt::format("found that {} is a file; expected a folder", folder.string()));
  if (fs::exists(place, unimportant) ? !may_write(place) : !may_write(folder))
    return says(fmt::format("found {}; expected a file that may be written",
                            lacking(fs::exists(place, unimportant) ? place : folder, "no permission to write it")));
  if (!is_stream(place) && !may_write(folder))
    return says(
        fmt::format("found no permission to write into {}; expected a folder that may be written", folder.string()));
  return {};
}

// The innermost folder on the way to `place` that exists.
fs::path existing_part(const fs::path& place) {
  auto part = plain(place);
  while (!part.empty() && !fs::exists(part, unimportant)) part = part.parent_path();
  return part.empty() ? fs::path(".") : part;
}

std::optional<std::string> trouble_with_folder(const fs::path& place, bool several) {
  const auto says = [&](const std::string& text) { return fmt::format("{}: {}", place.string(), text); };
  if (place.empty()) return "found an empty name; expected that of a folder";
  const auto part = existing_part(place);
  if (fs::exists(place, unimportant) && !fs::is_directory(place, unimportant))
    return says("found a file; expected a folder for the results");
  if (!fs::is_directory(part, unimportant))
    return says(fmt::format("found that {} is a file; expected a folder", part.string()));
  if (!may_write(part))
    return says(fmt::format("found {}; expected a folder that may be written",
                            lacking(part, "no permission to write into " + part.string())));
  if (several || !fs::exists(place, unimportant)) return {};
  std::error_code error;
  if (!fs::is_empty(place, error) && !error && read_result_record(place).empty())
    return says(
        "found a folder with other files; expected a new or empty folder, or an earlier result, whose files are "
        "replaced");
  return {};
}

// What lies on another disk than its folder, or in a folder that must not be written, is made inside.
fs::path pending_folder(const fs::path& place) {
  const auto beside = folder_of(place) / temporary_name(place);
  if (!fs::exists(place, unimportant)) return beside;
  if (!may_write(folder_of(place)) || ::access(folder_of(place).c_str(), X_OK) != 0)
    return plain(place) / temporary_name(place);
  struct stat here = {};
  struct stat above = {};
  const bool same_disk =
      ::stat(place.c_str(), &here) == 0 && ::stat(folder_of(place).c_str(), &above) == 0 && here.st_dev == above.st_dev;
  return same_disk ? beside : plain(place) / temporary_name(place);
}

[[noreturn]] void fail(const fs::path& place, const char* what, int error = errno) {
  throw std::runtime_error(fmt::format("{}: {}: {}", place.string(), what, machine::file_error_words(error)));
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

CLI::Option* add_out(CLI::App& command, std::string& out, const std::string& text, bool several) {
  const auto check = [several](const std::string& place) { return trouble_with_folder(place, several).value_or(""); };
  return command.add_option("--out", out, text)->check(CLI::Validator(check, ""))->type_name("DIR");
}

CLI::Option* add_output_file(CLI::App& command, const std::string& name, std::string& file, const std::string& text) {
  const auto check = [](const std::string& place) { return trouble_with_file(place).value_or(""); };
  return command.add_option(name, file, text)->check(CLI::Validator(check, ""))->type_name("FILE");
}

PendingFile::PendingFile(fs::path place) : place_(std::move(place)), stream_(is_stream(place_)) {
  if (const auto trouble = trouble_with_file(place_)) throw UsageError(*trouble);
  // A link stays a link.
  if (fs::is_symlink(place_, unimportant) && !stream_)
    if (const auto target = fs::canonical(place_, unimportant); !target.empty()) place_ = target;
  pending_ = (stream_ ? fs::temp_directory_path() : folder_of(place_)) / temporary_name(place_);
  register_temporary(pending_);
}
PendingFile::~PendingFile() {
  fs::remove(pending_, unimportant);
  forget_temporary(pending_);
}
void PendingFile::write(std::string_view content) const { machine::write_whole_file(pending_, content, place_); }
void PendingFile::fill(const std::function<void(const fs::path&)>& writer) const {
  errno = 0;
  try {
    writer(pending_);
  } catch (const std::runtime_error& error) {
    const int why = errno;
    const std::string text = error.what(), temporary = pending_.string();
    if (!text.starts_with(temporary)) throw;
    throw std::runtime_error(place_.string() + text.substr(temporary.size()) +
                             (why == 0 ? "" : ": " + machine::file_error_words(why)));
  }
}
void PendingFile::commit() {
  if (stream_) return machine::write_whole_file(place_, machine::read_whole_file(pending_, "a result"), place_);
  if (std::rename(pending_.c_str(), place_.c_str()) != 0) fail(place_, "cannot be written");
}

PendingFolder::PendingFolder(fs::path place, std::string command)
    : place_(std::move(place)), command_(std::move(command)) {
  if (const auto trouble = trouble_with_folder(place_, false)) throw UsageError(*trouble);
  pending_ = pending_folder(place_);
  for (auto above = folder_of(pending_); !above.empty() && !fs::exists(above, unimportant); above = above.parent_path())
    made_.insert(made_.begin(), above);
  std::error_code error;
  fs::create_directories(pending_, error);
  if (error) fail(place_, "cannot be created", error.value());
  register_temporary(pending_);
}
PendingFolder::~PendingFolder() {
  fs::remove_all(pending_, unimportant);
  forget_temporary(pending_);
  if (!committed_)
    for (auto above = made_.rbegin(); above != made_.rend(); ++above)
      fs::remove(*above, unimportant);  // empty ones only
}
void PendingFolder::write(std::string_view name, std::string_view content) const {
  machine::write_whole_file(pending_ / name, content, place_ / name);
}

void PendingFolder::commit() {
  auto record = read_result_record(place_);
  const auto made = names_in(pending_);
  std::vector<std::string> outdated, present = fs::exists(place_) ? names_in(place_) : std::vector<std::string>();
  for (const auto& name : made)
    if (contains(present, name) && !record.contains(name))
      throw UsageError(fmt::format("{}: found a file that no command of stiction made; expected none of that name",
                                   (place_ / name).string()));
  for (const auto& [name, command] : record)
    if (!contains(made, name) && (command == command_ || command.empty())) outdated.push_back(name);
  for (const auto& name : outdated) record.erase(name);
  for (const auto& name : made) record[name] = command_;
  write(result_record_file, result_record_text(record));
  without_interruption([&] {
    std::vector<std::string> leave;
    for (const auto& name : present)
      if (!contains(made, name) && !contains(outdated, name) && name != result_record_file &&
          name != pending_.filename())
        leave.push_back(name);
    if (!exchange(leave)) replace_each(outdated);
  });
  committed_ = true;
}

// The whole folder at once: what stays is linked into the new one, so that it is at its place at any time; what cannot
// be linked, as folders, follows a moment later. False, with nothing changed, where the file system cannot exchange.
bool PendingFolder::exchange(const std::vector<std::string>& leave) const {
  if (folder_of(pending_) == plain(place_)) return false;                   // it lies inside
  if (::rename(pending_.c_str(), plain(place_).c_str()) == 0) return true;  // new, or over an empty folder
  for (const auto& name : leave)
    if (fs::is_regular_file(fs::symlink_status(place_ / name, unimportant)))
      fs::create_hard_link(place_ / name, pending_ / name, unimportant);
  fs::permissions(pending_, fs::status(place_, unimportant).permissions(), unimportant);
  if (::renameat2(AT_FDCWD, pending_.c_str(), AT_FDCWD, plain(place_).c_str(), RENAME_EXCHANGE) != 0) {
    for (const auto& name : leave) fs::remove(pending_ / name, unimportant);
    return false;
  }
  for (const auto& name : leave)
    if (!fs::exists(fs::symlink_status(place_ / name, unimportant)) &&
        std::rename((pending_ / name).c_str(), (place_ / name).c_str()) != 0) {
      const int error = errno;
      // Nothing may be lost: the old folder comes back.
      ::renameat2(AT_FDCWD, pending_.c_str(), AT_FDCWD, plain(place_).c_str(), RENAME_EXCHANGE);
      fail(place_ / name, "cannot be kept", error);
    }
  return true;
}

// File by file, each in one step.
void PendingFolder::replace_each(const std::vector<std::string>& outdated) const {
  for (const auto& name : names_in(pending_))
    if (std::rename((pending_ / name).c_str(), (place_ / name).c_str()) != 0) fail(place_ / name, "cannot be written");
  for (const auto& name : outdated) fs::remove(place_ / name, unimportant);
}

}  // namespace stiction::host
