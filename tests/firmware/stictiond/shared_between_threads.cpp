// Ring, queue, mailbox and histogram with one thread at either end, for the thread sanitizer: rings that are full and
// go round many times. Status 1: a record came changed, twice or out of order, or one is neither read nor counted as
// lost; the sanitizer ends a race with its own status.
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <thread>

#include "firmware/stictiond/log_ring.hpp"
#include "firmware/stictiond/motion_mailbox.hpp"
#include "hal/modbus/write_queue.hpp"
#include "hal/time_histogram.hpp"

using namespace stiction;

namespace {

constexpr std::uint64_t records = 200'000;

// How often a reader waits for a full ring before it empties it beside the writer.
constexpr std::uint64_t full_rounds = 50;

bool ring_keeps_order() {
  const auto ring = std::make_unique<drive::LogRing>();
  std::atomic<std::uint64_t> rounds = 0;
  std::atomic<bool> written = false;
  std::uint64_t pushed = 0;
  std::thread writer([&] {
    for (; rounds < full_rounds || pushed < records; ++pushed)
      ring->push(static_cast<std::int64_t>(pushed), drive::LogLevel::info, "{} {} {}", {pushed, 2 * pushed, "name"});
    written = true;
  });
  std::uint64_t read = 0, lost = 0;
  std::int64_t last = -1;
  bool right = true;
  drive::LogRecord record;
  for (bool end = false; !end;) {
    while (rounds < full_rounds && ring->lost() == lost) std::this_thread::yield();
    end = written;
    while (ring->pop(record)) {
      right = right && record.time_ns > last && record.values[0].number() == record.time_ns &&
              record.values[1].number() == 2 * record.time_ns;
      last = record.time_ns;
      ++read;
    }
    lost = ring->lost();  // after it was empty: what is lost from now on finds it full again
    ++rounds;
  }
  writer.join();
  std::printf("ring: %llu of %llu records read, %llu lost, %llu times full\n", static_cast<unsigned long long>(read),
              static_cast<unsigned long long>(pushed), static_cast<unsigned long long>(ring->lost()),
              static_cast<unsigned long long>(full_rounds));
  return right && read + ring->lost() == pushed && read >= full_rounds * drive::LogRing::capacity;
}

// Two writes a request, which go in together or not at all.
bool queue_keeps_requests_whole() {
  const auto queue = std::make_unique<hal::WriteQueue>();
  std::atomic<std::uint64_t> rounds = 0, refused = 0;
  std::atomic<bool> written = false;
  std::uint64_t pushed = 0;
  std::thread writer([&] {
    std::uint16_t serial = 0;
    while (rounds < full_rounds) {
      const std::array writes{hal::RegisterWrite{.index = 1, .value = static_cast<double>(serial)},
                              hal::RegisterWrite{.index = 2, .value = static_cast<double>(serial)}};
      if (queue->push(writes)) {
        ++serial;
        ++pushed;
      } else {
        ++refused;
      }
    }
    written = true;
  });
  std::uint64_t taken = 0, full = 0;
  std::uint16_t serial = 0;
  bool right = true;
  for (bool end = false; !end;) {
    while (rounds < full_rounds && refused == full) std::this_thread::yield();
    full = refused;
    end = written;
    while (const auto first = queue->take()) {
      const auto second = queue->take();
      right = right && second && first->index == 1 && second->index == 2 && first->value == serial &&
              second->value == serial;
      ++serial;
      ++taken;
    }
    ++rounds;
  }
  writer.join();
  std::printf("queue: %llu requests, %llu refused\n", static_cast<unsigned long long>(taken),
              static_cast<unsigned long long>(refused.load()));
  return right && taken == pushed && full > 0;
}

// The newest target counts; a stop is never overtaken.
bool mailbox_gives_the_newest() {
  using What = drive::MotionWrite::What;
  const auto mailbox = std::make_unique<drive::MotionMailbox>();
  std::atomic<bool> written = false;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= records; ++i) {
      const std::array writes{drive::MotionWrite{.axis = i % 2, .what = What::target, .value = static_cast<double>(i)}};
      mailbox->put(writes);
    }
    written = true;
  });
  std::array<double, 2> last{};
  bool right = true;
  for (bool end = false; !end;) {
    end = written;
    mailbox->take([&](const drive::MotionWrite& write) {
      right = right && write.value > last[write.axis];
      last[write.axis] = write.value;
    });
  }
  writer.join();
  return right && last[0] == records && last[1] == records - 1;
}

bool histogram_counts_all() {
  const auto histogram = std::make_unique<hal::TimeHistogram>();
  std::atomic<bool> written = false;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < records; ++i) histogram->add(static_cast<std::int64_t>(i % 5000));
    written = true;
  });
  std::uint64_t last = 0;
  bool right = true;
  while (!written) {
    const auto counts = histogram->read();
    right = right && counts.total >= last && counts.minimum <= counts.maximum;
    last = counts.total;
  }
  writer.join();
  return right && histogram->read().total == records;
}

}  // namespace

int main() {
  return ring_keeps_order() && queue_keeps_requests_whole() && mailbox_gives_the_newest() && histogram_counts_all() ? 0
                                                                                                                    : 1;
}
