#include "firmware/stictiond/service_notify.hpp"

#include <systemd/sd-daemon.h>

namespace stiction::drive {
namespace {

void tell(const std::string& message) { ::sd_notify(0, message.c_str()); }

// A status is one line: what a second one held would be read as another assignment.
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

}  // namespace

bool ProgressWatch::moved(std::uint64_t progress, std::int64_t now_ns) {
  const bool first = !last_.has_value();
  const bool changed = !first && *last_ != progress;
  if (first || changed) moved_ns_ = now_ns;
  last_ = progress;
  starved_ = now_ns - moved_ns_ > limit_ns_;
  return changed;
}

ServiceNotify::ServiceNotify() {
  std::uint64_t microseconds = 0;
  if (::sd_watchdog_enabled(0, &microseconds) > 0) watchdog_ns_ = static_cast<std::int64_t>(microseconds) * 1000;
}

void ServiceNotify::ready(const std::string& status) { tell("READY=1\nSTATUS=" + one_line(status)); }
void ServiceNotify::status(const std::string& text) { tell("STATUS=" + one_line(text)); }
void ServiceNotify::stopping(const std::string& status) { tell("STOPPING=1\nSTATUS=" + one_line(status)); }

bool ServiceNotify::feed(std::uint64_t progress, std::int64_t now_ns) {
  if (!watchdog_ns_) return false;
  if (fed_progress_ && (*fed_progress_ == progress || now_ns - fed_ns_ < *watchdog_ns_ / 4)) return false;
  fed_progress_ = progress;
  fed_ns_ = now_ns;
  tell("WATCHDOG=1");
  return true;
}

}  // namespace stiction::drive
