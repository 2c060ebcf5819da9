#include "host/diagnose/classes/exact_record.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <utility>

namespace stiction::host {

std::vector<ExactRecord> draw(const ExactRecords& records, std::size_t begin, std::size_t end) {
  std::vector<std::optional<ExactRecord>> drawn(end - begin);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t k = next++; k < drawn.size(); k = next++) drawn[k] = records(begin + k);
  };
  std::vector<std::future<void>> workers;
  for (unsigned k = 0; k < std::max(std::thread::hardware_concurrency(), 1U); ++k)
    workers.push_back(std::async(std::launch::async, work));
  for (auto& worker : workers) worker.get();
  std::vector<ExactRecord> followed;
  for (auto& record : drawn)
    if (record) followed.push_back(std::move(*record));
  return followed;
}

}  // namespace stiction::host
