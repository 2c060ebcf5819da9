// Whole files as bytes, and what a file system refuses in the words of its user.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stiction::machine {

// A file that cannot be read: "FILE: found ...; expected ...".
class UnreadableFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What `error`, a value of errno, says of a path: "the disk is full".
std::string file_error_words(int error);

// All bytes of `file`; `expected`: what it should be, "a log", for the message. Throws UnreadableFile, with the nearest
// name in the same folder where there is no such file.
std::string read_whole_file(const std::filesystem::path& file, std::string_view expected);

// Makes or replaces `file` with `content`. Throws std::runtime_error when it cannot be made or the disk does not take
// all of it; `shown` is the path for the message.
void write_whole_file(const std::filesystem::path& file, std::string_view content, const std::filesystem::path& shown);

}  // namespace stiction::machine
