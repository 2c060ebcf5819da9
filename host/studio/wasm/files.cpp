// A page has no files: who asks for one is told so.
#include "firmware/machine/file/whole_file.hpp"

namespace stiction::machine {

std::string read_whole_file(const std::filesystem::path& file, std::string_view) {
  throw UnreadableFile(file.string() + ": found a page; expected a file system");
}

}  // namespace stiction::machine
