// A gpiochip and its lines as libgpiod hands them over, behind one face: libgpiod 1.6 (Debian 12; version 1 of the
// kernel's character device) in gpiod_1.cpp, libgpiod 2 (Debian 13; version 2) in gpiod_2.cpp. CMake takes the one that
// the installed header is of. What is refused is said by errno, as the library does; lines.cpp makes sentences of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/gpio/config.hpp"

namespace stiction::hal::gpiod {

// An edge as the kernel queued it.
struct KernelEdge {
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, taken in the interrupt
  bool rising = false;       // the line became active
  // Of the line's edges since it was requested, from 1 on, modulo 2^32: version 2 alone counts them.
  std::optional<std::uint32_t> number;
};

// Whether the kernel numbers edges: then it drops the oldest of a full queue, otherwise the newest.
bool numbers_edges();

// A line that this process holds; empty where it was refused.
class Line {
 public:
  struct Native;
  Line();
  explicit Line(std::unique_ptr<Native> native);
  Line(Line&&) noexcept;
  Line& operator=(Line&&) noexcept;
  ~Line();  // given back

  explicit operator bool() const { return native_ != nullptr; }
  // 1: active, 0: not, below 0: the chip does not answer.
  int level() const;
  // False: the chip does not take it. One ioctl over memory of the stack: also in a signal handler.
  bool set(bool active) const noexcept;
  // Of an input's edges, for poll(); does not block.
  int descriptor() const;
  // What the kernel has queued, oldest first, at most as many as fit. Below 0: nothing, with errno. Allocates nothing.
  int read_edges(std::span<KernelEdge> edges) const;

 private:
  std::unique_ptr<Native> native_;
};

class Chip {
 public:
  struct Native;
  // `path`: of its device. Empty with errno where it cannot be had.
  static Chip at(const std::string& path);
  // `chip`: path, name, label or number.
  static Chip find(const std::string& chip);
  Chip(Chip&&) noexcept;
  Chip& operator=(Chip&&) noexcept;
  ~Chip();

  explicit operator bool() const { return native_ != nullptr; }
  std::string name() const;  // the kernel's, such as gpiochip0
  std::string label() const;
  int line_count() const;
  std::string user(int offset) const;  // who holds the line; empty: the kernel does not say

  // `line`: below line_count(); `user`: what the kernel shows as the one who holds it; `bias`: of an input. Empty with
  // errno where refused.
  Line input(const LineConfig& line, const std::string& user, Bias bias) const;
  Line output(const LineConfig& line, const std::string& user) const;  // inactive

 private:
  explicit Chip(std::unique_ptr<Native> native);
  std::unique_ptr<Native> native_;
};

}  // namespace stiction::hal::gpiod
