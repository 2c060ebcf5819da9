// Any bytes as a file that a user names, and the columns that he states for it: refused with a reason, or a log that
// keeps its promises. The columns come first, up to a line end (an empty line: none are stated), then the file: a table
// in any encoding, compressed or not, an export, a trace. MAT-files are left to their library.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/machine/file/machine_file.hpp"
#include "host/log/mat_log.hpp"
#include "host/log/read_log.hpp"
#include "tests/fuzz/log_promises.hpp"

namespace stiction::fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto end = bytes.find('\n');
  const std::string columns(bytes.substr(0, end));
  const auto content = end == std::string_view::npos ? std::string_view() : bytes.substr(end + 1);
  if (host::is_mat_file(file.path(), content)) return 0;
  file.replace_by(content);
  try {
    check_promises(host::read_log(file.path(), {columns, {}}));
  } catch (const host::LogError& error) {
    if (std::string_view(error.what()).find("expected") == std::string_view::npos) finding(error.what());
  }
  return 0;
}

}  // namespace stiction::fuzz
