#include "firmware/stictiond/service_thread.hpp"

#include <sched.h>

#include <chrono>
#include <utility>

#include "hal/tick_clock.hpp"

namespace stiction::drive {
namespace {

constexpr std::chrono::milliseconds round_time{20};
constexpr std::int64_t status_interval_ns = 1'000'000'000;

}  // namespace

ServiceThread::Round::Round(LogRing& ring, LogSink sink, ServiceNotify& notify, ServiceQuestions questions,
                            std::int64_t starvation_ns)
    : reader_(ring, std::move(sink)), notify_(notify), questions_(std::move(questions)), watch_(starvation_ns) {}

void ServiceThread::Round::operator()(std::int64_t now_ns) {
  const std::uint64_t progress = questions_.progress();
  watch_.moved(progress, now_ns);
  if (watch_.starved() && !starved_ && questions_.starved) questions_.starved();
  starved_ = watch_.starved();
  notify_.feed(progress, now_ns);
  if (questions_.round) questions_.round();
  if (questions_.status && now_ns - status_ns_ >= status_interval_ns) {
    notify_.status(questions_.status());
    status_ns_ = now_ns;
  }
  reader_.drain();
}

ServiceThread::ServiceThread(LogRing& ring, LogSink sink, ServiceNotify& notify, ServiceQuestions questions,
                             std::int64_t starvation_ns)
    : round_(ring, std::move(sink), notify, std::move(questions), starvation_ns), thread_([this] { run(); }) {}

ServiceThread::~ServiceThread() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ServiceThread::run() {
  // Never at the loop's priority, whoever started the thread.
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
  const hal::MonotonicTime time;
  std::unique_lock lock(mutex_);
  for (bool end = false; !end;) {
    // Once more after the end is known: what the loop said last.
    end = wake_.wait_for(lock, round_time, [this] { return end_; });
    round_(time.now_ns());
  }
}

}  // namespace stiction::drive
