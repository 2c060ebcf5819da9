#include "firmware/machine/file/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "firmware/machine/file/nearest_name.hpp"

namespace stiction::machine {
namespace {

namespace fs = std::filesystem;

constexpr std::array words{
    std::pair{ENOENT, "there is no such folder"},
    std::pair{EACCES, "no permission"},
    std::pair{EPERM, "no permission"},
    std::pair{EISDIR, "it is a folder, not a file"},
    std::pair{ENOTDIR, "a part of the path is a file, not a folder"},
    std::pair{ENOSPC, "the disk is full"},
    std::pair{EDQUOT, "the quota of disk space is used up"},
    std::pair{EFBIG, "the file becomes larger than the system allows"},
    std::pair{EROFS, "the file system is read-only"},
    std::pair{ENAMETOOLONG, "the name is too long"},
    std::pair{ELOOP, "the symbolic links of the path lead in a circle"},
    std::pair{EMFILE, "too many files are open"},
    std::pair{EIO, "the disk reports an error"},
};

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using Handle = std::unique_ptr<std::FILE, Close>;

std::string nearest_file(const fs::path& file) {
  std::error_code error;
  std::vector<std::string> names;
  const auto folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  for (const auto& entry : fs::directory_iterator(folder, error)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());  // the order of a folder is chance
  return did_you_mean(file.filename().string(), {names.begin(), names.end()});
}

[[noreturn]] void fail_to_read(const fs::path& file, int error, std::string_view expected) {
  const std::string shown = file.empty() ? "\"\"" : file.string();
  std::error_code none;
  const auto folder = file.parent_path();
  if (error == EISDIR) throw UnreadableFile(fmt::format("{}: found a folder; expected {}", shown, expected));
  if (error == ENOENT && !folder.empty() && !fs::exists(folder, none))
    throw UnreadableFile(fmt::format("{}: found no folder {}; expected {} in it", shown, folder.string(), expected));
  if (error == ENOENT)
    throw UnreadableFile(fmt::format("{}: found no such file; expected {}{}", shown, expected, nearest_file(file)));
  if (error == EACCES)
    throw UnreadableFile(fmt::format("{}: found no permission to read it; expected {}", shown, expected));
  throw UnreadableFile(
      fmt::format("{}: found that it cannot be read: {}; expected {}", shown, file_error_words(error), expected));
}

}  // namespace

std::string file_error_words(int error) {
  const auto found = std::find_if(words.begin(), words.end(), [&](const auto& each) { return each.first == error; });
  return found != words.end() ? found->second : std::strerror(error);
}

std::string read_whole_file(const fs::path& file, std::string_view expected) {
  const Handle in(std::fopen(file.c_str(), "rb"));
  if (!in) fail_to_read(file, errno, expected);
  std::string text;
  std::array<char, 1 << 16> block{};
  for (std::size_t count; (count = std::fread(block.data(), 1, block.size(), in.get())) > 0;)
    text.append(block.data(), count);
  if (std::ferror(in.get()) != 0) fail_to_read(file, errno, expected);  // a folder opens, and refuses to be read
  return text;
}

void write_whole_file(const fs::path& file, std::string_view content, const fs::path& shown) {
  Handle out(std::fopen(file.c_str(), "wb"));
  const bool written = out && std::fwrite(content.data(), 1, content.size(), out.get()) == content.size() &&
                       std::fclose(out.release()) == 0;
  if (!written)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", shown.string(), file_error_words(errno)));
}

}  // namespace stiction::machine
