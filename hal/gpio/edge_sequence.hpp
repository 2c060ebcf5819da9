// What the edges of one line say of edges that did not come: by the numbers that version 2 of the kernel's character
// device gives them (Documentation/userspace-api/gpio, line_seqno of struct gpio_v2_line_event), and by their kind,
// which has to change from one to the next.
#pragma once

#include <cstdint>
#include <optional>

namespace stiction::hal {

class EdgeSequence {
 public:
  // The line's level from here on; the numbers go on.
  void start(bool level) { level_ = level; }

  // The next edge that was read; returns how many before it must have been lost, at least. By its number each one that
  // the kernel queued and dropped; by its kind a pulse that was over before its interrupt was served, which never had a
  // number. `rising`: the line became active; `number`: nullopt where the kernel counts none.
  std::uint64_t take(bool rising, std::optional<std::uint32_t> number) {
    std::uint64_t lost = 0;
    if (number) {
      lost = *number - last_ - 1u;  // modulo 2^32, as the kernel counts
      last_ = *number;
    }
    const bool level_before = level_ != (lost % 2 != 0);
    if (rising == level_before) ++lost;
    level_ = rising;
    return lost;
  }

  bool level() const { return level_; }

 private:
  std::uint32_t last_ = 0;  // the kernel's first number is 1
  bool level_ = false;
};

}  // namespace stiction::hal
