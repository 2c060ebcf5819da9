// What the drive tells the service manager (sd_notify(3)): ready, status, stopping, and that the loop makes progress.
// The watchdog is fed by the loop's progress alone: a thread beside the loop that lives on is no sign of life.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace stiction::drive {

// Whether a counter has moved on, and since when it has not.
class ProgressWatch {
 public:
  explicit ProgressWatch(std::int64_t limit_ns) : limit_ns_(limit_ns) {}

  // `progress`: any number that the loop changes every tick. True when it has changed since the last call. The first
  // call only starts the watch.
  bool moved(std::uint64_t progress, std::int64_t now_ns);

  // At the last call the counter had stood still for longer than the limit (Fault::watchdog_starved).
  bool starved() const { return starved_; }

 private:
  std::int64_t limit_ns_;
  std::optional<std::uint64_t> last_;
  std::int64_t moved_ns_ = 0;
  bool starved_ = false;
};

class ServiceNotify {
 public:
  // Reads $NOTIFY_SOCKET, $WATCHDOG_USEC and $WATCHDOG_PID. Without a manager every call does nothing.
  ServiceNotify();

  // The start is over: every check has passed.
  void ready(const std::string& status);
  void status(const std::string& text);
  void stopping(const std::string& status);

  // The manager's watchdog time, ns; none: it watches nothing.
  std::optional<std::int64_t> watchdog_ns() const { return watchdog_ns_; }

  // Call several times in the watchdog's time. Tells the manager that the drive lives when `progress` has moved on
  // since it was last told so, at most four times in its time. Returns whether it did.
  bool feed(std::uint64_t progress, std::int64_t now_ns);

 private:
  std::optional<std::int64_t> watchdog_ns_;
  std::optional<std::uint64_t> fed_progress_;
  std::int64_t fed_ns_ = 0;
};

}  // namespace stiction::drive
