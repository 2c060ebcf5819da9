#include "host/log/read_log.hpp"

#include <array>
#include <fstream>
#include <string_view>

#include "host/log/csv_log.hpp"
#include "host/log/mat_log.hpp"

namespace stiction::host {

Log read_log(const std::filesystem::path& file) {
  std::array<char, 16> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view begin(bytes.data(), static_cast<std::size_t>(in.gcount()));
  // A file that is not there is refused with the same words whatever its name.
  if (!begin.empty() && is_mat_file(file, begin)) return read_mat_log(file);
  if (begin.starts_with("PK\x03\x04"))
    throw LogError(file.string() +
                   ": found a zip archive; expected a CSV or MAT log (`stiction convert --map` reads the recordings of "
                   "drives)");
  return read_csv_log(file);
}

}  // namespace stiction::host
