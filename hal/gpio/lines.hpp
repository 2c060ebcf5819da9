// Lines of one gpiochip (gpiod.hpp): outputs, and inputs whose edges carry the kernel's time stamps.
//
// A tick costs one poll, a read for each line that changed, and one look at one line's level, each line in turn: where
// the kernel does not number its edges (libgpiod 1.6), the last ones before a standstill that it dropped show in a
// level that stays different and in nothing else; and so does a pulse that was over before its interrupt was served.
#pragma once

#include <poll.h>

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hal/gpio/config.hpp"
#include "hal/gpio/edge_queue.hpp"
#include "hal/gpio/edge_sequence.hpp"
#include "hal/gpio/gpiod.hpp"

namespace stiction::hal {

// A chip, line or channel that cannot be had; what() says which, why, and what to do.
class GpioError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The kernel's name of a chip, such as gpiochip0. `chip`: path, name, label or number. Throws GpioError.
std::string chip_name(const std::string& chip);

class Lines {
 public:
  // `chip`: path, name, label or number. Throws GpioError.
  Lines(const std::string& chip, Bias bias);
  ~Lines();  // outputs go inactive first
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  // Reserve a line for this process; `name` is what the kernel shows as its user and what messages call it. Both
  // return the line's place for the calls below. Throw GpioError.
  std::size_t add_input(const LineConfig& config, const std::string& name);
  std::size_t add_output(const LineConfig& config, const std::string& name);  // inactive

  // Takes over what happened since the last call. Never waits, allocates nothing. `now_ns`: CLOCK_MONOTONIC.
  void poll(std::int64_t now_ns);

  // Of an input, from the last poll. Levels and edges are those of the meaning, whatever the wiring.
  bool level(std::size_t input) const { return inputs_[input].sequence.level(); }
  bool was_active(std::size_t input) const;  // at some time since the poll before
  std::span<const Edge> edges(std::size_t input) const;
  bool queue_was_full(std::size_t input) const { return inputs_[input].edge_count == kernel_queue; }
  // At least, since the start. Where the kernel numbers edges, every one that it dropped.
  std::uint64_t lost_edges(std::size_t input) const { return inputs_[input].lost; }

  void set(std::size_t output, bool active);  // a system call only when it changes

  // Every output goes inactive, whatever was set last. Beside the thread that sets them, and in a signal handler.
  void cut() noexcept;

  // Whether the chip stopped answering: nothing that it said counts any more.
  bool failed() const { return failed_; }

 private:
  struct Input {
    gpiod::Line line;
    EdgeSequence sequence;
    std::array<Edge, kernel_queue> edges{};
    std::size_t edge_count = 0;
    std::uint64_t lost = 0;
    std::int64_t differs_since_ns = 0;  // the level from what the edges say; 0: it does not
  };
  struct Output {
    gpiod::Line line;
    bool active = false;
  };

  void take_offset(const LineConfig& line, const std::string& name);
  [[noreturn]] void refuse(const LineConfig& line, const std::string& name) const;
  void settle_level(Input& input);
  void drain(Input& input);
  void look_at(Input& input, std::int64_t now_ns);

  gpiod::Chip chip_;
  Bias bias_;
  std::string chip_name_;
  std::vector<Input> inputs_;
  std::vector<pollfd> descriptors_;  // of the inputs
  std::vector<Output> outputs_;
  std::vector<std::pair<int, std::string>> taken_;
  std::size_t looked_at_ = 0;
  bool failed_ = false;
};

}  // namespace stiction::hal
