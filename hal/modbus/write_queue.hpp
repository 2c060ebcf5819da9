// What clients wrote, from the server's thread to the one that acts upon it: a ring for one writer and one reader,
// wait-free on both sides. A request's writes go in together or not at all.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <span>

#include "hal/modbus/register_map.hpp"

namespace stiction::hal {

class WriteQueue {
 public:
  bool push(std::span<const RegisterWrite> writes) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) + writes.size() > size) return false;
    for (std::size_t i = 0; i < writes.size(); ++i) ring_[(head + i) % size] = writes[i];
    head_.store(head + writes.size(), std::memory_order_release);
    return true;
  }
  std::optional<RegisterWrite> take() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return {};
    const RegisterWrite write = ring_[tail % size];
    tail_.store(tail + 1, std::memory_order_release);
    return write;
  }

 private:
  static constexpr std::size_t size = 256;  // two of the longest requests
  std::array<RegisterWrite, size> ring_{};
  std::atomic<std::size_t> head_{0}, tail_{0};
};

}  // namespace stiction::hal
