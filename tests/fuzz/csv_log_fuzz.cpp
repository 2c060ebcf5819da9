// Any bytes as a CSV log: refused with a reason, or a log that keeps its promises and reads back as it was written.
#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "host/log/csv_log.hpp"

namespace stiction::fuzz {
namespace {

[[noreturn]] void finding(const char* what) {
  fmt::print(stderr, "finding: {}\n", what);
  std::abort();
}

void check(const host::Log& log) {
  if (log.t.size() < 2 || log.axes.empty() || !(log.period > 0.0)) finding("too little was accepted");
  for (std::size_t k = 1; k < log.t.size(); ++k)
    if (!(log.t[k] > log.t[k - 1])) finding("the time does not rise");
  for (const auto& axis : log.axes) {
    if (axis.x.empty() || (axis.i.empty() && axis.force.empty() && axis.u.empty())) finding("a channel is missing");
    for (const auto& channel : host::log_channels) {
      const auto& values = axis.*channel.values;
      if (!values.empty() && values.size() != log.t.size()) finding("a channel has another length");
      for (const double value : values)
        if (!std::isfinite(value)) finding("a value is not finite");
    }
  }
}

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
  check(log);
  if (!is_uniform(log)) return 0;
  try {
    check(host::parse_csv_log(host::csv_log_text(log), "again"));
  } catch (const host::LogError& error) {
    finding(error.what());
  }
  return 0;
}

}  // namespace stiction::fuzz
