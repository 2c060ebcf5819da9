#include "firmware/stictiond/store_thread.hpp"

#include <sched.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace stiction::drive {

struct StoreThread::Shared {
  std::mutex mutex;  // never held over a job
  std::condition_variable wake, idle;
  Job waiting;
  std::uint64_t asked = 0, done = 0;  // tickets
  bool last_stored = false;           // how the one of `done` ended
  bool end = false, ended = false;

  void run() {
    const sched_param ordinary{};
    ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
    std::unique_lock lock(mutex);
    while (true) {
      wake.wait(lock, [this] { return end || waiting; });
      if (!waiting) break;
      const Job job = std::exchange(waiting, nullptr);
      const std::uint64_t ticket = asked;
      lock.unlock();
      bool stored = true;
      try {
        job();
      } catch (...) {  // the job has said why
        stored = false;
      }
      lock.lock();
      done = ticket;
      last_stored = stored;
    }
    ended = true;
    idle.notify_all();
  }
};

StoreThread::StoreThread() : shared_(std::make_shared<Shared>()), thread_([shared = shared_] { shared->run(); }) {}

StoreThread::~StoreThread() {
  std::unique_lock lock(shared_->mutex);
  shared_->end = true;
  shared_->wake.notify_all();
  const bool ended =
      shared_->idle.wait_for(lock, std::chrono::milliseconds(patience_ms), [this] { return shared_->ended; });
  lock.unlock();
  if (ended)
    thread_.join();
  else
    thread_.detach();  // its disk does not answer; what it uses is its own
}

std::uint64_t StoreThread::ask(Job job) {
  const std::lock_guard lock(shared_->mutex);
  shared_->waiting = std::move(job);
  shared_->wake.notify_one();
  return ++shared_->asked;
}

StoreThread::Outcome StoreThread::outcome(std::uint64_t ticket) const {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->done < ticket) return Outcome::under_way;
  return shared_->last_stored ? Outcome::stored : Outcome::failed;
}

}  // namespace stiction::drive
