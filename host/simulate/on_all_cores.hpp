// Independent pieces of work on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace stiction::host {

// Calls work(0) to work(count - 1), each once, on as many threads as there are cores, and returns when all are done.
// What one throws is thrown when those that run have ended. `count`: of the pieces; `work`: may be called from several
// threads.
template <class Work>
void on_all_cores(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&] {
    for (std::size_t k = next++; k < count; k = next++) work(k);
  };
  std::vector<std::future<void>> workers;
  const std::size_t threads = std::min<std::size_t>(std::max(std::thread::hardware_concurrency(), 1U), count);
  for (std::size_t k = 1; k < threads; ++k) workers.push_back(std::async(std::launch::async, take));
  take();
  for (auto& worker : workers) worker.get();
}

}  // namespace stiction::host
