// Any bytes as a CSV log: refused with a reason, or a log that keeps its promises and reads back as it was written.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "host/log/csv_log.hpp"
#include "tests/fuzz/log_promises.hpp"

namespace stiction::fuzz {
namespace {

// Steps that only the few digits of their text explained may be refused when they are written in full.
bool is_uniform(const host::Log& log) {
  for (std::size_t k = 1; k < log.t.size(); ++k)
    if (!(std::abs(log.t[k] - log.t[k - 1] - log.period) < 1e-3 * log.period)) return false;
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  host::Log log;
  try {
    log = host::parse_csv_log({reinterpret_cast<const char*>(data), size}, "bytes");
  } catch (const host::LogError&) {
    return 0;
  }
  check_promises(log);
  if (!is_uniform(log)) return 0;
  try {
    check_promises(host::parse_csv_log(host::csv_log_text(log), "again"));
  } catch (const host::LogError& error) {
    finding(error.what());
  }
  return 0;
}

}  // namespace stiction::fuzz
