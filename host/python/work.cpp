#include "host/python/work.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace stiction::python {
namespace {

namespace py = pybind11;

// Ends the work; never seen outside.
struct Stopped {};

class Worker {
 public:
  explicit Worker(const std::function<void(const Report&)>& work, bool told)
      : thread_([this, &work, told] {
          try {
            work([this, told](std::string words) { report(std::move(words), told); });
          } catch (...) {
            failure_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          done_ = true;
          changed_.notify_all();
        }) {}

  // Waits a moment. Returns what was reported, and whether the work is over.
  std::pair<std::vector<std::string>, bool> wait() {
    constexpr auto between_looks_for_signals = std::chrono::milliseconds(50);
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, between_looks_for_signals, [this] { return done_ || !reports_.empty(); });
    return {std::exchange(reports_, {}), done_};
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  std::exception_ptr join() {
    const py::gil_scoped_release release;  // a thread that has called Python takes its leave of it
    thread_.join();
    return failure_;
  }

 private:
  void report(std::string words, bool told) {
    const std::lock_guard lock(mutex_);
    if (stop_) throw Stopped();
    if (!told || words.empty()) return;
    reports_.push_back(std::move(words));
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> reports_;
  std::exception_ptr failure_;
  bool done_ = false, stop_ = false;
  std::thread thread_;  // the last, as it uses all others
};

}  // namespace

void run_work(const std::function<void(const Report&)>& work, const py::object& progress) {
  Worker worker(work, !progress.is_none());
  std::exception_ptr stopped_by;
  for (bool done = false; !done;) {
    std::vector<std::string> reports;
    {
      const py::gil_scoped_release release;
      std::tie(reports, done) = worker.wait();
    }
    if (stopped_by) continue;
    try {
      for (const auto& words : reports) progress(words);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (...) {
      stopped_by = std::current_exception();
      worker.stop();
    }
  }
  const auto failure = worker.join();
  if (stopped_by) std::rethrow_exception(stopped_by);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace stiction::python
