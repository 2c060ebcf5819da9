// The log's way out: pipes that nobody reads, readers that are gone, devices that are full.
#include "firmware/stictiond/log_output.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

namespace stiction::test {
namespace {

class Pipe {
 public:
  Pipe() {
    ::signal(SIGPIPE, SIG_IGN);  // as the programme has it
    EXPECT_EQ(::pipe(ends_.data()), 0);
  }
  ~Pipe() {
    close_reader();
    ::close(ends_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writer() const { return ends_[1]; }
  void close_reader() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }
  // Reads until `end` has come.
  std::string read_until(const std::string& end) const {
    std::string text;
    std::array<char, 4096> block;
    while (text.find(end) == std::string::npos) {
      const ssize_t got = ::read(ends_[0], block.data(), block.size());
      if (got <= 0) break;
      text.append(block.data(), static_cast<std::size_t>(got));
    }
    return text;
  }
  bool is_full() const {
    pollfd writable{ends_[1], POLLOUT, 0};
    return ::poll(&writable, 1, 0) == 0;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

TEST(LogOutput, WritesLevelsInWordsOrAsTheJournalReadsThem) {
  for (const bool journal : {false, true}) {
    const Pipe pipe;
    drive::LogOutput output(pipe.writer(), journal);
    output.put(drive::LogLevel::error, "axis 1: fault");
    output.put(drive::LogLevel::info, "end");
    EXPECT_EQ(pipe.read_until("end\n"),
              journal ? "<3>axis 1: fault\n<6>end\n" : "stictiond: error: axis 1: fault\nstictiond: end\n");
  }
}

TEST(LogOutput, NeverWaitsForAReaderThatDoesNotReadAndSaysHowMuchItLost) {
  const Pipe pipe;
  drive::LogOutput output(pipe.writer(), false);
  const std::string line(1000, 'x');
  // A pipe holds 64 KiB: each call of these would wait for ever if it waited at all.
  std::uint64_t put = 0;
  for (; output.lost() < 100 || !pipe.is_full(); ++put) output.put(drive::LogLevel::notice, line);
  EXPECT_TRUE(pipe.is_full());
  EXPECT_GE(put, drive::LogOutput::capacity);
  const std::string lost = " lines of the log were lost because standard error did not take them";
  EXPECT_NE(pipe.read_until(lost).find(lost), std::string::npos);
}

TEST(LogOutput, EndsWhileItsReaderSleeps) {
  const Pipe pipe;
  {
    drive::LogOutput output(pipe.writer(), false);
    while (output.lost() == 0) output.put(drive::LogLevel::notice, std::string(1000, 'x'));
  }
  EXPECT_TRUE(pipe.is_full());
}

TEST(LogOutput, LivesOnWhereNobodyTakesItsLines) {
  Pipe pipe;
  pipe.close_reader();
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  constexpr int closed = 1'000'000;
  for (const int descriptor : {pipe.writer(), full, closed}) {
    drive::LogOutput output(descriptor, false);
    output.put(drive::LogLevel::error, "nobody hears this");
    while (output.lost() == 0) ::usleep(1000);
  }
  ::close(full);
}

}  // namespace
}  // namespace stiction::test
