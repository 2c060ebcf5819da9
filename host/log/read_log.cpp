#include "host/log/read_log.hpp"

#include "host/log/csv_log.hpp"

namespace stiction::host {

Log read_log(const std::filesystem::path& file) { return read_csv_log(file); }

}  // namespace stiction::host
