// The thread beside the loop, which may wait: it says what the loop logged, tells the service manager the drive's state
// and feeds its watchdog while the loop makes progress. It must be started before the loop's thread takes a processor
// for itself, because a new thread inherits that.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "firmware/stictiond/log_ring.hpp"
#include "firmware/stictiond/service_notify.hpp"

namespace stiction::drive {

// What the thread asks, all from its own side: each must be safe beside the running loop.
struct ServiceQuestions {
  std::function<std::uint64_t()> progress;  // a number that the loop changes every tick
  std::function<std::string()> status;      // one line for `systemctl status`, asked once a second
  std::function<void()> starved;            // the loop stood still for the watchdog's time; called once each time
  std::function<void()> round = {};         // called in each round, about every 20 ms
};

class ServiceThread {
 public:
  // `starvation_ns`: for which the loop may stand still. `ring`: messages of the loop; `sink`: where
  // they are written; `notify`: the service manager; `questions`: asked in each round.
  ServiceThread(LogRing& ring, LogSink sink, ServiceNotify& notify, ServiceQuestions questions,
                std::int64_t starvation_ns);
  // Says what is left in the ring.
  ~ServiceThread();
  ServiceThread(const ServiceThread&) = delete;
  ServiceThread& operator=(const ServiceThread&) = delete;
  ServiceThread(ServiceThread&&) = delete;
  ServiceThread& operator=(ServiceThread&&) = delete;

  // One round, as the thread makes one every 20 ms. For tests, and for a programme without the thread.
  class Round {
   public:
    // The same `ring`, `sink`, `notify`, `questions` and `starvation_ns` as of the thread.
    Round(LogRing& ring, LogSink sink, ServiceNotify& notify, ServiceQuestions questions, std::int64_t starvation_ns);
    void operator()(std::int64_t now_ns);

   private:
    LogReader reader_;
    ServiceNotify& notify_;
    ServiceQuestions questions_;
    ProgressWatch watch_;
    bool starved_ = false;
    std::int64_t status_ns_ = 0;
  };

 private:
  void run();

  Round round_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace stiction::drive
