#include "host/log/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "host/log/log.hpp"

namespace stiction::host {

std::string read_text_file(const std::filesystem::path& file) {
  std::error_code none;
  if (std::filesystem::is_directory(file, none)) throw LogError(file.string() + ": found a folder; expected a log");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw LogError(fmt::format("{}: cannot be read: {}; expected a log", file.string(), std::strerror(errno)));
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) throw LogError(file.string() + ": cannot be read to its end");
  return text;
}

void write_text_file(const std::filesystem::path& file, std::string_view content) {
  std::ofstream out(file, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace stiction::host
