#include "firmware/stictiond/log_ring.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

#include <string>

namespace stiction::drive {
namespace {

std::string text_of(const LogRecord& record) {
  fmt::dynamic_format_arg_store<fmt::format_context> values;
  for (const LogValue& value : record.values) {
    if (value.name() != nullptr)
      values.push_back(value.name());
    else
      values.push_back(value.number());
  }
  return fmt::format("{:.6f} s: ", static_cast<double>(record.time_ns) * 1e-9) +
         fmt::vformat(record.text.text(), values);
}

}  // namespace

std::size_t LogReader::drain() {
  std::size_t taken = 0;
  LogRecord record;
  // No more than the ring holds: a loop that writes without end must not hold its reader.
  for (; taken < LogRing::capacity && ring_.pop(record); ++taken) sink_(record.level, text_of(record));
  if (const std::uint64_t lost = ring_.lost(); lost != lost_said_) {
    sink_(LogLevel::warning,
          fmt::format("{} messages of the loop were lost because the buffer was full", lost - lost_said_));
    lost_said_ = lost;
  }
  return taken;
}

}  // namespace stiction::drive
