// How often a time fell into which bin. One thread adds, any other reads while it does; neither waits for the other.
// Bins are 64 an octave (1.6 % wide at most) from 128 ns to 69 s and 1 ns wide below, as of HdrHistogram (G. Tene): a
// bound of 12 us is then judged by a bin of 128 ns.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace stiction::hal {

namespace time_bins {
inline constexpr int octave_bits = 6;
inline constexpr std::size_t per_octave = 1U << octave_bits;
inline constexpr int last_width = 36;  // bits of the longest time that has its own bin
inline constexpr std::size_t count = per_octave + (last_width - octave_bits) * per_octave;

constexpr std::size_t index_of(std::int64_t time_ns) {
  const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(time_ns, 0, (1LL << last_width) - 1));
  if (value < per_octave) return static_cast<std::size_t>(value);
  const int octave = static_cast<int>(std::bit_width(value)) - 1 - octave_bits;
  return per_octave * static_cast<std::size_t>(octave) + static_cast<std::size_t>(value >> octave);
}

// The first time (ns) of a bin; that of bin `count` ends the last.
constexpr std::int64_t begin_of(std::size_t bin) {
  if (bin < 2 * per_octave) return static_cast<std::int64_t>(bin);
  const std::size_t octave = bin / per_octave - 1;
  return static_cast<std::int64_t>((per_octave + bin % per_octave) << octave);
}
}  // namespace time_bins

// What a histogram held when it was read. All times in ns.
struct TimeCounts {
  std::array<std::uint64_t, time_bins::count> counts{};
  std::uint64_t total = 0;
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  double mean = 0.0;

  // The end of the bin that holds this share (0 to 1) of all times, never beyond the maximum; 0 of nothing.
  std::int64_t quantile(double share) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total)));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      seen += counts[bin];
      if (seen > 0 && seen >= wanted) return std::min(time_bins::begin_of(bin + 1) - 1, maximum);
    }
    return maximum;
  }
};

class TimeHistogram {
 public:
  // By the one thread that measures. A negative time counts as 0.
  void add(std::int64_t time_ns) {
    add_to(counts_[time_bins::index_of(time_ns)], 1);
    add_to(sum_ns_, std::max<std::int64_t>(time_ns, 0));
    if (time_ns > maximum_ns_.load(std::memory_order_relaxed)) maximum_ns_.store(time_ns, std::memory_order_relaxed);
    if (time_ns < minimum_ns_.load(std::memory_order_relaxed)) minimum_ns_.store(time_ns, std::memory_order_relaxed);
  }

  // The longest time so far, ns; 0 before any. By any thread: without the counts, which are 16 kB.
  std::int64_t maximum() const { return std::max<std::int64_t>(maximum_ns_.load(std::memory_order_relaxed), 0); }

  // Forgets every time. By the thread that measures, while no other reads.
  void clear() {
    for (auto& count : counts_) count.store(0, std::memory_order_relaxed);
    sum_ns_.store(0, std::memory_order_relaxed);
    minimum_ns_.store(none_yet_minimum, std::memory_order_relaxed);
    maximum_ns_.store(none_yet_maximum, std::memory_order_relaxed);
  }

  // By any thread. Every count as it was at some moment during the call.
  TimeCounts read() const {
    TimeCounts result;
    for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
      result.counts[bin] = counts_[bin].load(std::memory_order_relaxed);
      result.total += result.counts[bin];
    }
    if (result.total == 0) return result;
    result.maximum = maximum();
    result.minimum = std::clamp<std::int64_t>(minimum_ns_.load(std::memory_order_relaxed), 0, result.maximum);
    result.mean = static_cast<double>(sum_ns_.load(std::memory_order_relaxed)) / static_cast<double>(result.total);
    return result;
  }

 private:
  // With one writer a load and a store are enough: no locked instruction in the loop.
  template <class T>
  static void add_to(std::atomic<T>& counter, std::type_identity_t<T> increment) {
    counter.store(counter.load(std::memory_order_relaxed) + increment, std::memory_order_relaxed);
  }

  static constexpr std::int64_t none_yet_minimum = INT64_MAX, none_yet_maximum = -1;

  std::array<std::atomic<std::uint64_t>, time_bins::count> counts_{};
  std::atomic<std::int64_t> sum_ns_ = 0;
  std::atomic<std::int64_t> minimum_ns_ = none_yet_minimum;
  std::atomic<std::int64_t> maximum_ns_ = none_yet_maximum;
};

}  // namespace stiction::hal
