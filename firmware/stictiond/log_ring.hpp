// What the loop has to say, on its way to a thread that may wait: a ring of fixed records with one writer and one
// reader (L. Lamport, "Specifying concurrent program modules", 1983). Neither side waits, allocates or calls the
// kernel; text is made by the reader. What finds no room is lost and counted.
#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

namespace stiction::drive {

enum class LogLevel : std::uint8_t { error = 3, warning = 4, notice = 5, info = 6 };  // of syslog

// A string literal in fmt's notation: only one can be constructed from, so the record may keep the pointer.
class LogText {
 public:
  template <std::size_t N>
  consteval LogText(const char (&text)[N]) : text_(text) {}  // NOLINT(google-explicit-constructor)
  constexpr LogText() = default;
  constexpr const char* text() const { return text_; }

 private:
  const char* text_ = "";
};

// An integer, or a text that lives as long as the programme: a name out of a table.
class LogValue {
 public:
  constexpr LogValue() = default;
  constexpr LogValue(std::integral auto number)  // NOLINT(google-explicit-constructor)
      : number_(static_cast<std::int64_t>(number)) {}
  constexpr LogValue(const char* name) : name_(name) {}  // NOLINT(google-explicit-constructor)
  constexpr std::int64_t number() const { return number_; }
  constexpr const char* name() const { return name_; }  // nullptr: a number

 private:
  const char* name_ = nullptr;
  std::int64_t number_ = 0;
};

struct LogRecord {
  std::int64_t time_ns = 0;
  LogText text;
  std::array<LogValue, 5> values{};
  LogLevel level = LogLevel::info;
};

class LogRing {
 public:
  static constexpr std::size_t capacity = 1024;

  // By the loop's thread alone. False: no room, counted as lost.
  bool push(const LogRecord& record) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == capacity) {
      lost_.store(lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    records_[head % capacity] = record;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // From the loop, wait-free. `time_ns`: on the loop's clock; `level`: of the message; `text`: a literal with at most
  // five {}; `values`: what goes into them. False when the ring is full: the message is counted as lost.
  bool push(std::int64_t time_ns, LogLevel level, LogText text, std::array<LogValue, 5> values = {}) {
    return push({time_ns, text, values, level});
  }

  // By the reader's thread alone. False: empty.
  bool pop(LogRecord& record) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    record = records_[tail % capacity];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }  // by any thread

 private:
  // Apart, so that writer and reader do not pull one cache line to and fro.
  alignas(64) std::atomic<std::size_t> head_ = 0;
  alignas(64) std::atomic<std::size_t> tail_ = 0;
  alignas(64) std::atomic<std::uint64_t> lost_ = 0;
  std::array<LogRecord, capacity> records_{};
};

using LogSink = std::function<void(LogLevel, std::string_view text)>;

// Takes records out of a ring and says them as text, "12.345678 s: axis 1: fault encoder frozen", and how many were
// lost since the last time.
class LogReader {
 public:
  LogReader(LogRing& ring, LogSink sink) : ring_(ring), sink_(std::move(sink)) {}

  // What is in the ring now. Returns how many records it took.
  std::size_t drain();

 private:
  LogRing& ring_;
  LogSink sink_;
  std::uint64_t lost_said_ = 0;
};

}  // namespace stiction::drive
