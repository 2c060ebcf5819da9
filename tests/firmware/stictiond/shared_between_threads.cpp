// Ring and histogram with one thread at either end, for the thread sanitizer. Status 1: a record came changed, twice or
// out of order, or one is neither read nor counted as lost; the sanitizer ends a race with its own status.
#include <cstdint>
#include <cstdio>
#include <memory>
#include <thread>

#include "firmware/stictiond/log_ring.hpp"
#include "hal/time_histogram.hpp"

using namespace stiction;

namespace {

constexpr std::uint64_t records = 200'000;

bool ring_keeps_order() {
  const auto ring = std::make_unique<drive::LogRing>();
  std::atomic<bool> written = false;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < records; ++i)
      ring->push(static_cast<std::int64_t>(i), drive::LogLevel::info, "{} {} {}", {i, 2 * i, "name"});
    written = true;
  });
  std::uint64_t read = 0;
  std::int64_t last = -1;
  bool right = true;
  drive::LogRecord record;
  for (bool end = false; !end;) {
    end = written;
    while (ring->pop(record)) {
      right = right && record.time_ns > last && record.values[0].number() == record.time_ns &&
              record.values[1].number() == 2 * record.time_ns;
      last = record.time_ns;
      ++read;
    }
  }
  writer.join();
  std::printf("ring: %llu of %llu records read, %llu lost\n", static_cast<unsigned long long>(read),
              static_cast<unsigned long long>(records), static_cast<unsigned long long>(ring->lost()));
  return right && read + ring->lost() == records;
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

int main() { return ring_keeps_order() && histogram_counts_all() ? 0 : 1; }
