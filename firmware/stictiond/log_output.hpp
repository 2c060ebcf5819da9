// Lines on their way to standard error, whose reader may be slow, asleep or gone: a thread of its own writes them and
// may wait as long as it likes; who logs never does. What finds no room is lost and counted, and the next line that can
// be written says how many were.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <thread>

#include "firmware/stictiond/log_ring.hpp"

namespace stiction::drive {

class LogOutput {
 public:
  static constexpr std::size_t capacity = 1024;       // lines that wait
  static constexpr std::size_t longest_line = 2048;   // bytes; what is longer is cut
  static constexpr std::int64_t patience_ms = 1'000;  // at the end, for a reader that does not read

  // `descriptor`: written to, and not closed here; `journal`: the level stands in front of a line as the journal reads
  // it ("<4>"), else in words for a person.
  LogOutput(int descriptor, bool journal);
  // Waits until all is written, at most for `patience_ms`.
  ~LogOutput();
  LogOutput(const LogOutput&) = delete;
  LogOutput& operator=(const LogOutput&) = delete;
  LogOutput(LogOutput&&) = delete;
  LogOutput& operator=(LogOutput&&) = delete;

  // From any thread but the loop's; never waits for the reader and never throws. `level`: of the message; `text`: one
  // line.
  void put(LogLevel level, std::string_view text) noexcept;

  std::uint64_t lost() const noexcept;  // lines that found no room, or that the descriptor refused

 private:
  struct Shared;  // outlives this object where its thread is held by a write

  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

// Whether the journal listens on standard error ($JOURNAL_STREAM).
bool journal_listens();

}  // namespace stiction::drive
