#include "host/log/text_file.hpp"

#include "firmware/machine/file/whole_file.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

std::string read_text_file(const std::filesystem::path& file, std::string_view expected) {
  try {
    return machine::read_whole_file(file, expected);
  } catch (const machine::UnreadableFile& error) {
    throw LogError(error.what());
  }
}

void write_text_file(const std::filesystem::path& file, std::string_view content) {
  machine::write_whole_file(file, content, file);
}

}  // namespace stiction::host
