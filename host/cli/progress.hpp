// A progress line on standard error for work over a second, when a person is there to read it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace stiction::host {

class Progress {
 public:
  // `what` is done, "circles", in `total` steps; 0: the number is not known, and only the time is shown. The line
  // appears after a second and is drawn again while the work goes on, also between steps.
  // `shown`: false where another process shows it.
  explicit Progress(std::string what, std::size_t total = 0, bool shown = true);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  // wipes the line

  // One more done; `now`: what comes next. May be called from any thread.
  void add(std::string_view now = {});

  // `done` steps are done in all; from the first call on the line says when the rest will be. From any thread.
  void reach(std::size_t done);

 private:
  void draw_until_done();
  void draw() const;

  std::string what_, now_;
  std::size_t total_;
  std::size_t done_ = 0;
  // Where reach() began: steps that were done before, and when.
  std::optional<std::pair<std::size_t, std::chrono::steady_clock::time_point>> first_reached_;
  bool over_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;  // only where standard error is a terminal
};

// What `work` returns, with a line that says `what` is going on and for how long.
template <class Work>
auto during(const std::string& what, Work work) {
  const Progress progress(what);
  return work();
}

}  // namespace stiction::host
