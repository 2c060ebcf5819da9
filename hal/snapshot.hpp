// The newest state of one thread for another one, without a lock on either side: three buffers, of which the writer
// fills one, the reader reads one, and the third changes hands by one atomic exchange. Neither ever waits, and the
// reader never sees a state half written. For exactly one writer and one reader.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace stiction::hal {

template <class T>
class Snapshot {
 public:
  Snapshot() = default;
  explicit Snapshot(const T& first) : buffers_{first, first, first} {}

  // What the writer fills; it holds an older state.
  T& next() { return buffers_[writing_]; }
  void publish() { writing_ = middle_.exchange(writing_ | fresh, std::memory_order_acq_rel) & index; }
  void publish(const T& state) {
    next() = state;
    publish();
  }

  // The newest published state; the first one before any. It stays as it is until the next call.
  const T& latest() {
    is_new_ = (middle_.load(std::memory_order_relaxed) & fresh) != 0;
    if (is_new_) reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & index;
    return buffers_[reading_];
  }
  // Whether the last latest() gave a state that the one before had not given.
  bool is_new() const { return is_new_; }

 private:
  static constexpr std::uint8_t index = 3, fresh = 4;
  std::array<T, 3> buffers_{};
  std::uint8_t writing_ = 0;
  std::atomic<std::uint8_t> middle_{1};
  std::uint8_t reading_ = 2;
  bool is_new_ = false;
};

}  // namespace stiction::hal
