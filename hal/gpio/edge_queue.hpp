// Edges of one line on their way from the kernel to who counts them, in a ring of fixed size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace stiction::hal {

struct Edge {
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, taken in the interrupt
  bool rising = false;       // the line became active
};

// What the kernel keeps of a line's edges until they are read. When it is full, version 1 of the character device drops
// the newest (gpiolib-cdev.c: DECLARE_KFIFO(events, struct gpioevent_data, 16)), version 2 the oldest; there it is
// asked for as many.
inline constexpr std::size_t kernel_queue = 16;

class EdgeQueue {
 public:
  bool empty() const { return size_ == 0; }
  const Edge& front() const { return edges_[first_]; }
  void pop() {
    first_ = (first_ + 1) % edges_.size();
    --size_;
  }
  // False: no room.
  bool push(const Edge& edge) {
    if (size_ == edges_.size()) return false;
    edges_[(first_ + size_) % edges_.size()] = edge;
    ++size_;
    return true;
  }
  void clear() { size_ = 0; }

 private:
  std::array<Edge, 4 * kernel_queue> edges_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace stiction::hal
