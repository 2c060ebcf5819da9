// Brings things to the disk in a thread of its own, whatever time that takes: who asks never waits, and asks later how
// it ended.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

namespace stiction::drive {

class StoreThread {
 public:
  static constexpr std::int64_t patience_ms = 2'000;  // at the end, for a disk that does not answer

  enum class Outcome : std::uint8_t { under_way, stored, failed };
  // What to do; it throws where it fails. It must own all that it uses: a disk may hold it for longer than who asked
  // lives.
  using Job = std::function<void()>;

  StoreThread();
  // Waits for the job under way, at most for `patience_ms`.
  ~StoreThread();
  StoreThread(const StoreThread&) = delete;
  StoreThread& operator=(const StoreThread&) = delete;
  StoreThread(StoreThread&&) = delete;
  StoreThread& operator=(StoreThread&&) = delete;

  // A ticket for outcome(), not 0. Of jobs that wait the last one alone is done: it stores what the others would have.
  std::uint64_t ask(Job job);
  // Of a ticket of ask(); for one that a later job took the place of, that one's.
  Outcome outcome(std::uint64_t ticket) const;

 private:
  struct Shared;  // outlives this object where its thread is held by a disk

  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace stiction::drive
